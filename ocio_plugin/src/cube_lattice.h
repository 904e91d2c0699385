// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

namespace metamer::ocio {

/// Where a signal lies in a lattice over 0 ... 1 with `size` nodes a side, as a tetrahedral look-up sees it: the cell
/// is cut into six tetrahedra along its diagonal from low to high, and the value is affine on each.
///
/// Corners of the tetrahedron are bit masks within the cell (1: red, 2: green, 4: blue), from 0 to 7 by one bit a step.
struct CubeStencil {
  std::uint32_t node = 0;  ///< of corner 0, red fastest
  std::array<std::uint8_t, 4> corner = {};
  std::array<float, 4> weight = {};
};

/// @param signal  clamped to 0 ... 1
CubeStencil cubeStencil(const Eigen::Vector3f& signal, int size);

/// From a node to the corner of its cell with a given mask, in nodes.
inline std::uint32_t cornerStep(unsigned mask, int size) {
  const auto side = static_cast<std::uint32_t>(size);
  return (mask & 1U) + ((mask >> 1) & 1U) * side + ((mask >> 2) & 1U) * side * side;
}

/// A symmetric 3 x 3 matrix: (0,0) (1,0) (1,1) (2,0) (2,1) (2,2).
using Symmetric = std::array<float, 6>;

/// Normal equations of a lattice of three values a node, as 3 x 3 blocks: each node with itself and the seven others of
/// the cell above it, which is all that tetrahedra couple.
class CubeEquations {
 public:
  explicit CubeEquations(int size);

  void clear();
  /// Adds the square, in a metric, of `value at the stencil - target`.
  void add(const CubeStencil& stencil, const Symmetric& metric, const Eigen::Vector3f& target, float weight);
  /// Adds `weight` times the square of the difference of two nodes, an edge of a cell apart, less `target`.
  void addDifference(std::uint32_t node, unsigned mask, const Symmetric& metric, const Eigen::Vector3f& target);
  /// Adds the square of a node less `target`.
  void addValue(std::uint32_t node, const Symmetric& metric, const Eigen::Vector3f& target);

  /// Mean of the blocks on the diagonal.
  Symmetric meanBlock() const;

  /// Solves by conjugate gradients, preconditioned by the blocks on the diagonal. The order of sums is fixed.
  /// @param nodes  in: where to start, and the values of nodes that are held. out: the solution
  /// @param held   a node for which this is not 0 keeps its value
  /// @param fall   ends where the residual has fallen by this factor, or after `most` steps
  /// @return steps taken
  int solve(std::vector<Eigen::Vector3f>& nodes, const std::vector<std::uint8_t>& held, double fall, int most) const;

 private:
  void multiply(const std::vector<Eigen::Vector3f>& x, std::vector<Eigen::Vector3f>& result) const;

  std::array<std::uint32_t, 8> m_steps = {};
  std::vector<std::array<Symmetric, 8>> m_blocks;  // a node's row: with the corner of each mask of its cell
  std::vector<Eigen::Vector3f> m_right;
};

}  // namespace metamer::ocio
