// SPDX-License-Identifier: Apache-2.0
#include "cube_fit.h"

#include <algorithm>
#include <cmath>

#include "cube_lattice.h"
#include "parallel.h"

namespace metamer::ocio {
namespace {

/// Rounds of weighted least squares.
constexpr int kRounds = 4;
/// A sample's squared weight grows with its squared error, between these parts of the 99th percentile: above it there
/// is no more to gain, below the first what is small already must not be forgotten.
constexpr float kLeastPart = 0.5F;
constexpr double kQuantile = 0.99;
/// Errors beyond this are weighed by what they really are, within a factor, where the quadratic form misjudges them.
constexpr float kSmall = 0.2F;
constexpr float kMostBeyond = 3.0F;
/// Weight of moving unlike the neighbour, and of moving at all, against the mean node's: they decide what samples leave
/// open.
constexpr float kStiffness = 1e-3F;
constexpr float kAttachment = 1e-3F;
/// Of conjugate gradients.
constexpr double kResidualFall = 1e-3;
constexpr int kMostSteps = 100;

/// A lattice's value at a sample.
Eigen::Vector3f valueAt(const CubeSample& sample, const std::vector<Eigen::Vector3f>& nodes,
                        const std::array<std::uint32_t, 8>& steps) {
  Eigen::Vector3f value = Eigen::Vector3f::Zero();
  for (std::size_t k = 0; k < 4; ++k) {
    value += sample.stencil.weight[k] * nodes[sample.stencil.node + steps[sample.stencil.corner[k]]];
  }
  return value;
}

/// CIEDE2000 of a small deviation.
float smallError(const Symmetric& m, const Eigen::Vector3f& d) {
  const float square = m[0] * d[0] * d[0] + m[2] * d[1] * d[1] + m[5] * d[2] * d[2] +
                       2.0F * (m[1] * d[0] * d[1] + m[3] * d[0] * d[2] + m[4] * d[1] * d[2]);
  return std::sqrt(std::max(0.0F, square));
}

/// Errors of a lattice at all samples, and what the quadratic form takes for them.
struct Errors {
  std::vector<float> full;
  std::vector<float> quadratic;
};

Errors errorsOf(const std::vector<CubeSample>& samples, const std::vector<Eigen::Vector3f>& nodes,
                const std::array<std::uint32_t, 8>& steps, const CubeJudge& judge) {
  constexpr std::size_t kBlock = 4096;
  Errors errors{std::vector<float>(samples.size()), std::vector<float>(samples.size())};
  parallelFor(static_cast<int>((samples.size() + kBlock - 1) / kBlock), [&](int block) {
    const std::size_t first = kBlock * static_cast<std::size_t>(block);
    const std::size_t count = std::min(kBlock, samples.size() - first);
    std::vector<float> rgba(4 * count, 1.0F);
    for (std::size_t k = 0; k < count; ++k) {
      const CubeSample& sample = samples[first + k];
      const Eigen::Vector3f value = valueAt(sample, nodes, steps);
      std::copy(value.begin(), value.end(), rgba.begin() + static_cast<std::ptrdiff_t>(4 * k));
      errors.quadratic[first + k] = smallError(sample.metric, value - sample.target);
    }
    judge.errors({samples.data() + first, count}, rgba, {errors.full.data() + first, count});
  });
  return errors;
}

Symmetric scaled(const Symmetric& metric, float factor) {
  Symmetric result = metric;
  for (float& value : result) {
    value *= factor;
  }
  return result;
}

/// A metric of its mean size, alike in all directions: deviations of nodes are no errors yet.
Symmetric isotropic(const Symmetric& metric) {
  const float mean = (metric[0] + metric[2] + metric[5]) / 3.0F;
  return {mean, 0.0F, mean, 0.0F, 0.0F, mean};
}

void addSmoothness(CubeEquations& equations, const std::vector<Eigen::Vector3f>& start, int size,
                   const Symmetric& metric) {
  const Symmetric stiffness = scaled(metric, kStiffness);
  const Symmetric attachment = scaled(metric, kAttachment);
  std::uint32_t node = 0;
  for (int blue = 0; blue < size; ++blue) {
    for (int green = 0; green < size; ++green) {
      for (int red = 0; red < size; ++red, ++node) {
        equations.addValue(node, attachment, start[node]);
        const std::array<bool, 3> hasNext = {red + 1 < size, green + 1 < size, blue + 1 < size};
        for (unsigned axis = 0; axis < 3; ++axis) {
          if (hasNext[axis]) {
            const std::uint32_t other = node + cornerStep(1U << axis, size);
            equations.addDifference(node, 1U << axis, stiffness, start[other] - start[node]);
          }
        }
      }
    }
  }
}

}  // namespace

void fitCube(std::vector<Eigen::Vector3f>& nodes, int size, const std::vector<CubeSample>& samples,
             const CubeJudge& judge) {
  if (samples.empty()) {
    return;
  }
  std::array<std::uint32_t, 8> steps{};
  for (unsigned mask = 0; mask < 8; ++mask) {
    steps[mask] = cornerStep(mask, size);
  }
  std::vector<Eigen::Vector3f> highest(nodes.size());
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    highest[k] = nodes[k].cwiseMax(1.0F);
    nodes[k] = nodes[k].cwiseMax(0.0F);
  }
  const std::vector<Eigen::Vector3f> start = nodes;
  std::vector<std::uint8_t> held(nodes.size(), 0);
  for (int k = 0; k < size; ++k) {
    held[static_cast<std::size_t>(k) * cornerStep(7, size)] = 1;
  }

  CubeEquations equations(size);
  Symmetric smoothness{};
  std::vector<float> weights(samples.size(), 1.0F);
  for (int round = 0; round < kRounds; ++round) {
    equations.clear();
    for (std::size_t k = 0; k < samples.size(); ++k) {
      const CubeSample& sample = samples[k];
      equations.add(sample.stencil, sample.metric, sample.target.cwiseMax(0.0F), weights[k]);
    }
    if (round == 0) {
      smoothness = isotropic(equations.meanBlock());
    }
    addSmoothness(equations, start, size, smoothness);
    equations.solve(nodes, held, kResidualFall, kMostSteps);
    if (round + 1 == kRounds) {
      break;
    }
    const Errors errors = errorsOf(samples, nodes, steps, judge);
    std::vector<float> sorted = errors.full;
    const auto rank = static_cast<std::ptrdiff_t>(kQuantile * static_cast<double>(sorted.size() - 1));
    std::nth_element(sorted.begin(), sorted.begin() + rank, sorted.end());
    const float reference = std::max(sorted[static_cast<std::size_t>(rank)], 1e-9F);
    // Half way from the last weights, which keeps them from swinging.
    double sum = 0.0;
    for (std::size_t k = 0; k < samples.size(); ++k) {
      const float part = std::clamp(errors.full[k] / reference, kLeastPart, 1.0F);
      const float beyond = errors.quadratic[k] > kSmall
                               ? std::clamp(errors.full[k] / errors.quadratic[k], 1.0F / kMostBeyond, kMostBeyond)
                               : 1.0F;
      weights[k] = std::sqrt(weights[k]) * part * beyond;
      sum += static_cast<double>(weights[k]);
    }
    const auto level = static_cast<float>(static_cast<double>(samples.size()) / sum);
    for (float& weight : weights) {
      weight *= level;
    }
  }
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    if (held[k] == 0) {
      nodes[k] = nodes[k].cwiseMax(0.0F).cwiseMin(highest[k]);
    }
  }
}

}  // namespace metamer::ocio
