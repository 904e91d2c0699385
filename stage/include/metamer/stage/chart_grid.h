// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

namespace metamer::stage {

/// Where the patches of a photographed chart lie: a perspective of a grid of equal cells.
class ChartGrid {
 public:
  static constexpr int kMostAlong = 1000;

  /// @param corners  four pixels: the outer corner of the first patch, then that at the end of its row, then round
  /// @param columns, rows  of patches, 1 ... kMostAlong
  /// @throws spectral::InputError outside that range, or where they are not the corners of a convex quadrilateral
  ChartGrid(const std::vector<Eigen::Vector2d>& corners, int columns, int rows);

  int columns() const { return m_columns; }
  int rows() const { return m_rows; }
  /// A point of the chart in cells (0 ... columns, 0 ... rows) as a pixel.
  Eigen::Vector2d pixelAt(const Eigen::Vector2d& cells) const;
  /// A pixel as a point of the chart in cells.
  Eigen::Vector2d cellsAt(const Eigen::Vector2d& pixel) const;
  /// The square that is averaged for a patch: the middle half of its cell, each way.
  std::array<Eigen::Vector2d, 4> sampledSquare(int column, int row) const;
  bool isInSampledSquare(const Eigen::Vector2d& pixel, int column, int row) const;

 private:
  int m_columns;
  int m_rows;
  Eigen::Matrix3d m_pixelFromCells;
  Eigen::Matrix3d m_cellsFromPixel;
};

/// How alike two lists of values are up to scale and offset: Pearson's correlation, 0 where one is constant.
/// @throws spectral::InputError where they differ in length
double likeness(const Eigen::VectorXd& values, const Eigen::VectorXd& expected);

}  // namespace metamer::stage
