// SPDX-License-Identifier: Apache-2.0
#include "cube/cube_fit.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "cube/cube_lattice.h"
#include "operators/parallel.h"

namespace metamer::ocio {
namespace {

/// Rounds of weighted least squares.
constexpr int kRounds = 5;
/// A round multiplies a sample's weight, of which it keeps a power, by its squared error up to the 99th percentile: the
/// rounds raise the errors to ever higher powers, toward the least percentile. From this part of it on, below which
/// what is small already must not be forgotten. Beyond it the weight falls off again: what is out of reach anyhow is
/// not to spoil the rest.
constexpr float kKept = 0.85F;
constexpr float kLeastPart = 0.6F;
constexpr double kQuantile = 0.99;
/// Errors beyond this are weighed by what they really are: where a signal crosses between a logarithm and its toe the
/// quadratic form misjudges them thirtyfold, and neighbours would be bent to mend what is no error.
constexpr float kSmall = 0.2F;
/// Weight of moving unlike the neighbour, and of moving at all, against the mean node's: they decide what samples leave
/// open.
constexpr float kStiffness = 1e-3F;
constexpr float kAttachment = 1e-3F;
/// Layers of untouched nodes that follow the touched ones: what they move by falls to a third from one to the next.
constexpr int kLayers = 5;
/// Of conjugate gradients: the next round changes more than what is left.
constexpr double kResidualFall = 0.02;
constexpr int kMostSteps = 100;

using Nodes = std::vector<Eigen::Vector3f>;
using Mask = std::vector<std::uint8_t>;

class Fit {
 public:
  Fit(Nodes& nodes, int size, const std::vector<CubeSample>& samples, const CubeJudge& judge, bool belowZero)
      : m_nodes(nodes), m_size(size), m_samples(samples), m_judge(judge), m_weights(samples.size(), 1.0F) {
    for (unsigned mask = 0; mask < 8; ++mask) {
      m_steps[mask] = cornerStep(mask, size);
    }
    if (belowZero) {
      for (const CubeSample& sample : samples) {
        m_lowest = m_lowest.cwiseMin(sample.target);
      }
      for (int k = 0; k < size; ++k) {
        m_lowest = m_lowest.cwiseMin(nodes[static_cast<std::size_t>(k) * m_steps[7]]);
      }
    }
    m_highest.reserve(nodes.size());
    for (Eigen::Vector3f& node : nodes) {
      m_highest.emplace_back(node.cwiseMax(1.0F));
      node = node.cwiseMax(m_lowest);
    }
    m_held.assign(nodes.size(), 0);
    for (int k = 0; k < size; ++k) {
      m_held[static_cast<std::size_t>(k) * m_steps[7]] = 1;
    }
    m_touched.assign(nodes.size(), 0);
    for (const CubeSample& sample : samples) {
      for (std::size_t k = 0; k < 4; ++k) {
        if (sample.stencil.weight[k] > 0.0F) {
          m_touched[sample.stencil.node + m_steps[sample.stencil.corner[k]]] = 1;
        }
      }
    }
  }

  void run() {
    const Nodes start = m_nodes;
    CubeEquations equations(m_size, m_touched);
    Symmetric smoothness = Symmetric::Zero();
    for (int round = 0; round < kRounds; ++round) {
      if (round > 0) {
        weigh();
      }
      equations.clear();
      addSamples(equations);
      if (round == 0) {
        smoothness = isotropic(equations.meanBlock());
      }
      equations.addSmoothness(kStiffness * smoothness, kAttachment * smoothness, start);
      equations.solve(m_nodes, m_held, kResidualFall, kMostSteps);
    }
    follow(start);
    for (std::size_t k = 0; k < m_nodes.size(); ++k) {
      if (m_held[k] == 0) {
        m_nodes[k] = m_nodes[k].cwiseMax(m_lowest).cwiseMin(m_highest[k]);
      }
    }
  }

 private:
  /// A metric of its mean size, alike in all directions: deviations of nodes are no errors yet.
  static Symmetric isotropic(const Symmetric& metric) {
    return Symmetric::Identity() * (metric.diagonal().sum() / 3.0F);
  }

  /// CIEDE2000 of a small deviation.
  static float smallError(const Symmetric& m, const Eigen::Vector3f& d) {
    return std::sqrt(std::max(0.0F, d.dot((m * d).head<3>())));
  }

  /// The lattice's value at a sample.
  Eigen::Vector3f valueAt(const CubeSample& sample) const {
    Eigen::Vector3f value = Eigen::Vector3f::Zero();
    for (std::size_t k = 0; k < 4; ++k) {
      value += sample.stencil.weight[k] * m_nodes[sample.stencil.node + m_steps[sample.stencil.corner[k]]];
    }
    return value;
  }

  /// Samples come ordered by node, and those of one plane of blue reach no further than the next: every other plane at
  /// once.
  void addSamples(CubeEquations& equations) const {
    const auto firstOf = [&](int blue) {
      const std::uint32_t node = static_cast<std::uint32_t>(blue) * m_steps[4];
      return std::lower_bound(m_samples.begin(), m_samples.end(), node,
                              [](const CubeSample& sample, std::uint32_t at) { return sample.stencil.node < at; }) -
             m_samples.begin();
    };
    for (const int odd : {0, 1}) {
      parallelFor((m_size - odd + 1) / 2, [&](int pair) {
        const int blue = 2 * pair + odd;
        const auto last = static_cast<std::size_t>(firstOf(blue + 1));
        for (auto k = static_cast<std::size_t>(firstOf(blue)); k < last; ++k) {
          const CubeSample& sample = m_samples[k];
          equations.add(sample.stencil, sample.metric, sample.target.cwiseMax(m_lowest), m_weights[k]);
        }
      });
    }
  }

  /// Calls body(first, last) for all samples in blocks, on any threads.
  template <typename Body>
  void overBlocks(const Body& body) const {
    constexpr std::size_t kBlock = 4096;
    parallelFor(static_cast<int>((m_samples.size() + kBlock - 1) / kBlock), [&](int block) {
      const std::size_t first = kBlock * static_cast<std::size_t>(block);
      body(first, std::min(first + kBlock, m_samples.size()));
    });
  }

  /// Errors of the lattice at all samples, and what the quadratic form takes for them. Small ones are what it says.
  struct Errors {
    std::vector<float> full;
    std::vector<float> quadratic;
  };

  Errors errors() const {
    Errors errors{std::vector<float>(m_samples.size()), std::vector<float>(m_samples.size())};
    overBlocks([&](std::size_t first, std::size_t last) {
      std::vector<std::size_t> large;
      std::vector<CubeSample> judged;
      std::vector<float> rgba;
      for (std::size_t k = first; k < last; ++k) {
        const Eigen::Vector3f value = valueAt(m_samples[k]);
        errors.full[k] = errors.quadratic[k] = smallError(m_samples[k].metric, value - m_samples[k].target);
        if (errors.quadratic[k] > kSmall && !m_samples[k].isNoise) {
          large.push_back(k);
          judged.push_back(m_samples[k]);
          rgba.insert(rgba.end(), {value[0], value[1], value[2], 1.0F});
        }
      }
      std::vector<float> found(large.size());
      m_judge.errors(judged, rgba, found);
      for (std::size_t k = 0; k < large.size(); ++k) {
        errors.full[large[k]] = found[k];
      }
    });
    return errors;
  }

  /// Weighs the samples by their errors, on from the last weights, which keeps them from swinging.
  void weigh() {
    const Errors found = errors();
    std::vector<float> sorted = found.full;
    const auto rank = static_cast<std::ptrdiff_t>(kQuantile * static_cast<double>(sorted.size() - 1));
    std::nth_element(sorted.begin(), sorted.begin() + rank, sorted.end());
    const float reference = std::max(sorted[static_cast<std::size_t>(rank)], 1e-9F);
    overBlocks([&](std::size_t first, std::size_t last) {
      for (std::size_t k = first; k < last; ++k) {
        const float part = std::max(found.full[k] / reference, kLeastPart);
        const float beyond = found.quadratic[k] > kSmall ? found.full[k] / found.quadratic[k] : 1.0F;
        const float counted = std::min(part, 1.0F / part);
        m_weights[k] = std::pow(m_weights[k], kKept) * counted * counted * beyond;
      }
    });
    const double sum = std::accumulate(m_weights.begin(), m_weights.end(), 0.0);
    const auto level = static_cast<float>(static_cast<double>(m_samples.size()) / sum);
    for (float& weight : m_weights) {
      weight *= level;
    }
  }

  /// Untouched nodes move as their neighbours do, and less from layer to layer (Jacobi's steps of a screened Laplace
  /// equation, from no movement).
  void follow(const Nodes& start) {
    const auto side = static_cast<std::size_t>(m_size);
    Nodes moves(m_nodes.size());
    for (std::size_t k = 0; k < m_nodes.size(); ++k) {
      moves[k] = m_nodes[k] - start[k];
    }
    for (int layer = 0; layer < kLayers; ++layer) {
      const Nodes before = moves;
      parallelFor(m_size, [&](int blue) {
        std::size_t node = static_cast<std::size_t>(blue) * side * side;
        for (std::size_t green = 0; green < side; ++green) {
          for (std::size_t red = 0; red < side; ++red, ++node) {
            if (m_touched[node] != 0 || m_held[node] != 0) {
              continue;
            }
            const std::array<std::size_t, 3> at = {red, green, static_cast<std::size_t>(blue)};
            Eigen::Vector3f sum = Eigen::Vector3f::Zero();
            float count = 1.0F;
            for (unsigned axis = 0; axis < 3; ++axis) {
              const std::size_t step = m_steps[1U << axis];
              if (at[axis] > 0) {
                sum += before[node - step];
                count += 1.0F;
              }
              if (at[axis] + 1 < side) {
                sum += before[node + step];
                count += 1.0F;
              }
            }
            moves[node] = sum / count;
          }
        }
      });
    }
    for (std::size_t k = 0; k < m_nodes.size(); ++k) {
      m_nodes[k] = start[k] + moves[k];
    }
  }

  Nodes& m_nodes;
  int m_size;
  const std::vector<CubeSample>& m_samples;
  const CubeJudge& m_judge;
  std::vector<float> m_weights;
  std::array<std::uint32_t, 8> m_steps = {};
  Eigen::Vector3f m_lowest = Eigen::Vector3f::Zero();
  Nodes m_highest;
  Mask m_held;
  Mask m_touched;
};

}  // namespace

void fitCube(std::vector<Eigen::Vector3f>& nodes, int size, const std::vector<CubeSample>& samples,
             const CubeJudge& judge, bool belowZero) {
  if (!samples.empty()) {
    Fit(nodes, size, samples, judge, belowZero).run();
  }
}

}  // namespace metamer::ocio
