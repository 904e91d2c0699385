// SPDX-License-Identifier: Apache-2.0
#include "metamer/stage/chart_grid.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <string>

#include "metamer/spectral/argument_checks.h"
#include "metamer/spectral/input_error.h"

namespace metamer::stage {
namespace {

/// Half the side of a sampled square, in cells.
constexpr double kHalfSide = 0.25;

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

Eigen::Vector2d applied(const Eigen::Matrix3d& homography, const Eigen::Vector2d& point) {
  return (homography * point.homogeneous()).hnormalized();
}

}  // namespace

ChartGrid::ChartGrid(const std::vector<Eigen::Vector2d>& corners, int columns, int rows)
    : m_columns(columns), m_rows(rows) {
  spectral::requireWithin("columns", columns, 1, kMostAlong);
  spectral::requireWithin("rows", rows, 1, kMostAlong);
  double turn = 0;
  bool isConvex = corners.size() == 4;
  for (std::size_t i = 0; isConvex && i < 4; ++i) {
    const double area = cross(corners[(i + 1) % 4] - corners[i], corners[(i + 2) % 4] - corners[(i + 1) % 4]);
    isConvex = std::isfinite(area) && area != 0 && area * turn >= 0;
    turn = area;
  }
  if (!isConvex) {
    throw spectral::InputError("", "corners", std::to_string(corners.size()),
                               "must be the four corners of the chart in order round it, none on a line with others");
  }
  // pixel = (h1 x + h2 y + h3, h4 x + h5 y + h6) / (h7 x + h8 y + 1), from four points.
  Eigen::Matrix<double, 8, 8> system;
  Eigen::Matrix<double, 8, 1> values;
  const std::array<Eigen::Vector2d, 4> cells = {Eigen::Vector2d(0, 0), Eigen::Vector2d(columns, 0),
                                                Eigen::Vector2d(columns, rows), Eigen::Vector2d(0, rows)};
  for (Eigen::Index i = 0; i < 4; ++i) {
    const double x = cells[static_cast<std::size_t>(i)].x();
    const double y = cells[static_cast<std::size_t>(i)].y();
    const Eigen::Vector2d& pixel = corners[static_cast<std::size_t>(i)];
    system.row(2 * i) << x, y, 1, 0, 0, 0, -pixel.x() * x, -pixel.x() * y;
    system.row(2 * i + 1) << 0, 0, 0, x, y, 1, -pixel.y() * x, -pixel.y() * y;
    values.segment<2>(2 * i) = pixel;
  }
  const Eigen::Matrix<double, 8, 1> h = system.fullPivLu().solve(values);
  m_pixelFromCells << h[0], h[1], h[2], h[3], h[4], h[5], h[6], h[7], 1;
  m_cellsFromPixel = m_pixelFromCells.inverse();
}

Eigen::Vector2d ChartGrid::pixelAt(const Eigen::Vector2d& cells) const {
  return applied(m_pixelFromCells, cells);
}

Eigen::Vector2d ChartGrid::cellsAt(const Eigen::Vector2d& pixel) const {
  return applied(m_cellsFromPixel, pixel);
}

std::array<Eigen::Vector2d, 4> ChartGrid::sampledSquare(int column, int row) const {
  const Eigen::Vector2d middle(column + 0.5, row + 0.5);
  return {pixelAt(middle + Eigen::Vector2d(-kHalfSide, -kHalfSide)),
          pixelAt(middle + Eigen::Vector2d(kHalfSide, -kHalfSide)),
          pixelAt(middle + Eigen::Vector2d(kHalfSide, kHalfSide)),
          pixelAt(middle + Eigen::Vector2d(-kHalfSide, kHalfSide))};
}

bool ChartGrid::isInSampledSquare(const Eigen::Vector2d& pixel, int column, int row) const {
  const Eigen::Vector2d offset = cellsAt(pixel) - Eigen::Vector2d(column + 0.5, row + 0.5);
  return offset.cwiseAbs().maxCoeff() <= kHalfSide;
}

double likeness(const Eigen::VectorXd& values, const Eigen::VectorXd& expected) {
  spectral::requireAsMany("values", values.size(), "are expected", expected.size());
  const Eigen::VectorXd a = values.array() - values.mean();
  const Eigen::VectorXd b = expected.array() - expected.mean();
  const double size = a.norm() * b.norm();
  return size > 0 ? a.dot(b) / size : 0;
}

}  // namespace metamer::stage
