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

/// A symmetric 3 x 3 matrix by its columns, each with a zero below it, and a vector of three with one: four floats are
/// the processor's word.
using Symmetric = Eigen::Matrix<float, 4, 3>;
using Padded = Eigen::Vector4f;

/// Normal equations of the nodes of a lattice that samples touch, three values a node, as 3 x 3 blocks: each node with
/// itself and with the seven others of the cell above it, which is all that tetrahedra couple.
///
/// Rows are the touched nodes in the lattice's order. Sums have a fixed order, whatever the number of threads.
class CubeEquations {
 public:
  /// @param touched  a node of the lattice for which this is not 0 gets a row
  CubeEquations(int size, const std::vector<std::uint8_t>& touched);

  void clear();
  /// Adds the square, in a metric, of `value at the stencil - target`. All corners of some weight have rows.
  /// May run at once with others whose stencils lie two planes of blue away or more.
  void add(const CubeStencil& stencil, const Symmetric& metric, const Eigen::Vector3f& target, float weight);
  /// Adds that the nodes should move as their neighbours along the axes do, and not at all.
  /// @param stiffness   of moving unlike a neighbour
  /// @param attachment  to the starting values
  /// @param start       of all nodes of the lattice
  void addSmoothness(const Symmetric& stiffness, const Symmetric& attachment,
                     const std::vector<Eigen::Vector3f>& start);

  /// Mean of the blocks on the diagonal.
  Symmetric meanBlock() const;

  /// Solves by conjugate gradients, preconditioned by the blocks on the diagonal.
  /// @param nodes  all of the lattice's. in: where to start, and the values of nodes that are held. out: the solution
  /// @param held   a node for which this is not 0 keeps its value
  /// @param fall   ends where the residual has fallen by this factor, or after `most` steps
  /// @return steps taken
  int solve(std::vector<Eigen::Vector3f>& nodes, const std::vector<std::uint8_t>& held, double fall, int most) const;

 private:
  using Column = std::vector<Padded>;
  static constexpr std::uint32_t kNone = 0xFFFFFFFFU;

  Padded rowTimes(std::size_t row, const Column& x) const;

  std::array<std::uint32_t, 8> m_steps = {};
  std::vector<std::uint32_t> m_rowOf;                 // of a node, or kNone
  std::vector<std::uint32_t> m_nodeOf;                // of a row
  std::vector<std::array<std::uint32_t, 8>> m_above;  // row of a row's cell corner, or kNone
  std::vector<std::array<std::uint32_t, 8>> m_below;  // row whose cell has this row at a corner, or kNone
  std::vector<std::array<Symmetric, 8>> m_blocks;     // a row's: with the corner of each mask of its cell
  Column m_right;
};

}  // namespace metamer::ocio
