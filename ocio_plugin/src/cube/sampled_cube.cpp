// SPDX-License-Identifier: Apache-2.0
#include "cube/sampled_cube.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

#include "metamer/ocio/pixel_processor.h"
#include "metamer/sip/homogeneous_map.h"
#include "operators/parallel.h"

namespace metamer::ocio {
namespace {

/// Cubes of at least this size take their nodes from the homogeneous map: its build then costs less than the nodes'
/// own solves, and its error is far below the lattice's.
constexpr int kMapFromSize = 40;
/// Two colours whose channels' ratios agree as well as this are one chromaticity.
constexpr float kSameRatio = 2e-6F;

/// The gain from one colour to another of the same chromaticity, nothing where it is another.
std::optional<float> gainBetween(const float* from, const float* to) {
  const float gain = to[1] / from[1];
  for (std::size_t k = 0; k < 3; ++k) {
    if (!(gain > 0.0F) || !(std::abs(to[k] - gain * from[k]) <= kSameRatio * std::abs(to[k]))) {
      return std::nullopt;
    }
  }
  return gain;
}

/// The lights of nodes along diagonals, to be solved together. Above the toe of a logarithm a diagonal is one
/// chromaticity at rising exposures, and one solve is enough for it.
class Diagonals {
 public:
  /// @param rgba  of all nodes; kept
  explicit Diagonals(std::span<float> rgba) : m_rgba(rgba) {}

  void add(std::size_t first, std::size_t step, std::size_t count) {
    const float* solved = nullptr;
    for (std::size_t k = count; k-- > 0;) {
      float* pixel = m_rgba.data() + 4 * (first + k * step);
      const std::optional<float> gain = solved != nullptr ? gainBetween(solved, pixel) : std::nullopt;
      if (!gain) {
        m_colours.emplace_back(Eigen::Map<const Eigen::Vector3f>(pixel).cast<double>());
        solved = pixel;
      }
      m_nodes.push_back({pixel, m_colours.size() - 1, gain.value_or(1.0F)});
    }
  }

  void apply(const sip::SpectralTransform& transform) {
    transform.apply(m_colours);
    for (const Node& node : m_nodes) {
      Eigen::Map<Eigen::Vector3f>(node.pixel) = (static_cast<double>(node.gain) * m_colours[node.solved]).cast<float>();
    }
  }

 private:
  struct Node {
    float* pixel;
    std::size_t solved;
    float gain;
  };
  std::span<float> m_rgba;
  std::vector<Eigen::Vector3d> m_colours;
  std::vector<Node> m_nodes;
};

}  // namespace

std::vector<Eigen::Vector3f> sampledCube(const sip::SpectralTransform& transform, const Signal& axes,
                                         const Signal& signal, int size) {
  const PixelProcessor toEngine(axes.toEngine);
  const PixelProcessor fromEngine(signal.fromEngine);
  const auto side = static_cast<std::size_t>(size);
  std::vector<float> rgba(4 * side * side * side);
  const auto plane = [&](int blue) {
    return std::span<float>(rgba).subspan(4 * side * side * static_cast<std::size_t>(blue), 4 * side * side);
  };
  const auto at = [size](int k) { return static_cast<float>(static_cast<double>(k) / (size - 1)); };
  parallelFor(size, [&](int blue) {
    float* node = plane(blue).data();
    for (int green = 0; green < size; ++green) {
      for (int red = 0; red < size; ++red, node += 4) {
        node[0] = at(red);
        node[1] = at(green);
        node[2] = at(blue);
        node[3] = 1.0F;
      }
    }
    toEngine.apply(plane(blue));
  });
  if (size >= kMapFromSize) {
    const sip::HomogeneousMap map = sip::buildHomogeneousMap(transform, sip::kDefaultMapTolerance, parallelFor);
    parallelFor(size, [&](int blue) { map.apply(plane(blue)); });
  } else {
    // Every diagonal starts on one of the three faces through black.
    parallelFor(size, [&](int a) {
      Diagonals diagonals(rgba);
      for (int b = 0; b < size; ++b) {
        const auto start = [&](int red, int green, int blue) {
          const auto first = static_cast<std::size_t>(red) +
                             side * (static_cast<std::size_t>(green) + side * static_cast<std::size_t>(blue));
          const auto count = side - static_cast<std::size_t>(std::max({red, green, blue}));
          diagonals.add(first, 1 + side + side * side, count);
        };
        start(0, a, b);
        if (a > 0) {
          start(a, 0, b);
          if (b > 0) {
            start(a, b, 0);
          }
        }
      }
      diagonals.apply(transform);
    });
  }
  std::vector<Eigen::Vector3f> nodes(side * side * side);
  parallelFor(size, [&](int blue) {
    fromEngine.apply(plane(blue));
    for (std::size_t k = 0; k < side * side; ++k) {
      nodes[side * side * static_cast<std::size_t>(blue) + k] =
          Eigen::Map<const Eigen::Vector3f>(plane(blue).data() + 4 * k);
    }
  });
  return nodes;
}

}  // namespace metamer::ocio
