// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "lights/light_tree.h"
#include "metamer/spectral/vector_lanes.h"

namespace metamer::spectral_ref {

/// A light tree with eight children a node, laid out for vector lanes: a light is drawn by what it may give to a point,
/// from the root down, among eight branches at a time.
class LightBranches {
 public:
  /// About as many leaves at most: of more lights several share one, and are told apart by intensity alone.
  static constexpr std::size_t kMostLeaves = std::size_t{1} << 17U;

  /// @param tree  of at least one light
  explicit LightBranches(const LightTree& tree);

  /// Points that leaves are drawn for at once, at most.
  static constexpr std::size_t kMostTogether = 16;

  /// Lights that lie together in the tree's order.
  struct Leaf {
    std::uint32_t begin = 0;
    std::uint32_t end = 0;
    float probability = 0;  ///< of coming to the leaf; 0: no light reaches the point
    double u = 0;           ///< what is left of the random number, 0 ... 1, exclusive
  };
  /// Draws a leaf for each of several points: while one waits for its next node, another goes on.
  /// @param leaves  as many; hold u, 0 ... 1, exclusive, and take the rest
  void descend(std::span<const LitPoint> points, std::span<Leaf> leaves) const;
  /// The leaf of a position, with the very probability that descend() states.
  Leaf leafOf(const LitPoint& point, std::uint32_t position) const;

 private:
  static constexpr std::size_t kWidth = 8;
  template <typename T>
  using Each = std::array<T, kWidth>;

  /// What LightTree::Node has, of eight children; those that are not there have no intensity.
  /// Infinitely far ones lie along their axis, at a distance of 1, seen under the angle that they spread over.
  struct alignas(64) Node {
    std::array<Each<float>, 3> center{};
    Each<float> radius{};
    std::array<Each<float>, 3> axis{};
    Each<float> cosSpread{};
    Each<float> sinSpread{};
    Each<float> intensity{};
    Each<float> isInfinite{};     ///< 1 or 0
    Each<std::uint32_t> begin{};  ///< its range in the order; of those that are not there, behind all
    Each<std::uint32_t> end{};
    Each<std::uint32_t> child{};  ///< node, or kLeaf
  };
  static constexpr std::uint32_t kLeaf = 0;  // no node has the root below it
  static constexpr std::uint32_t kBehindAll = 0xffffffffU;

  METAMER_VECTOR_LANES static Each<float> importances(const Node& node, const LitPoint& point);
  static std::uint32_t step(const Node& node, const LitPoint& point, Leaf& leaf);
  void add(const LightTree& tree, std::uint32_t root, std::size_t index, std::uint32_t leafSize);

  std::vector<Node> m_nodes;
};

}  // namespace metamer::spectral_ref
