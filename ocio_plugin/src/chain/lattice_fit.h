// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

namespace metamer::ocio {

/// A lattice of rectangles over the unit square that holds three values a node. Between nodes it is what a tetrahedral
/// lookup gives a table that does not depend on its third axis but by a plain sum: affine on the triangles into which
/// the diagonals from low to high corners cut the cells.
struct PlaneLattice {
  std::array<std::vector<double>, 2> ticks;  ///< where the nodes lie along either coordinate, 0 ... 1, rising
  std::vector<Eigen::Vector3d> nodes;        ///< second coordinate fastest

  int size() const { return static_cast<int>(ticks[0].size()); }
  Eigen::Vector2d place(int i, int j) const { return {ticks[0][i], ticks[1][j]}; }

  std::size_t index(int i, int j) const { return static_cast<std::size_t>(i) * ticks[1].size() + j; }

  /// The three nodes round a point and their weights. The point is clamped to the square.
  struct Stencil {
    std::array<std::size_t, 3> node;
    std::array<double, 3> weight;
  };
  Stencil stencil(const Eigen::Vector2d& point) const;
  Eigen::Vector3d at(const Eigen::Vector2d& point) const;
};

/// What the lattice should give at a point.
struct LatticeSample {
  Eigen::Vector2d point;
  Eigen::Vector3d value;
  Eigen::Matrix3d metric;  ///< squared error of a deviation d: d' metric d; symmetric, positive semidefinite
};

/// Node values of least squared error over the samples, by sparse normal equations. Where samples leave nodes free,
/// they keep to the shape of the values they came with.
/// @param lattice   its nodes are replaced
/// @param unknowns  which unknown, from 0, each node is; nodes may share one; below 0: the node keeps its value
void fitLattice(PlaneLattice& lattice, const std::vector<LatticeSample>& samples, const std::vector<int>& unknowns);

}  // namespace metamer::ocio
