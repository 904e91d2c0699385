// SPDX-License-Identifier: Apache-2.0
#include "metamer/stage/stage_geometry.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "metamer/spectral/argument_checks.h"

namespace metamer::stage {

double rectangleFormFactor(double width, double height, double distance) {
  spectral::requireAbove("width", width, 0);
  spectral::requireAbove("height", height, 0);
  spectral::requireAbove("distance", distance, 0);
  const double a = 0.5 * width / distance;
  const double b = 0.5 * height / distance;
  const double sideA = std::sqrt(1 + a * a);
  const double sideB = std::sqrt(1 + b * b);
  return 2 / std::numbers::pi * (a / sideA * std::atan(b / sideA) + b / sideB * std::atan(a / sideB));
}

double calibrationSquareBeta(double width, double height, double distance) {
  return 1 / rectangleFormFactor(width, height, distance);
}

Eigen::Vector3d LatLong::direction(int column, int row) const {
  const double latitude = std::numbers::pi * (0.5 - (row + 0.5) / height);
  const double longitude = 2 * std::numbers::pi * (0.5 - (column + 0.5) / width);
  return {std::sin(longitude) * std::cos(latitude), std::sin(latitude), std::cos(longitude) * std::cos(latitude)};
}

double LatLong::solidAngle(int row) const {
  const double top = std::numbers::pi * (0.5 - static_cast<double>(row) / height);
  const double bottom = std::numbers::pi * (0.5 - (row + 1.0) / height);
  return 2 * std::numbers::pi / width * (std::sin(top) - std::sin(bottom));
}

DiffuseConvolution::DiffuseConvolution(LatLong layout, const Eigen::Vector3d& facing)
    : m_layout(layout), m_facing(facing.normalized()) {
  spectral::requireWithin("width", layout.width, 1, std::numeric_limits<int>::max());
  spectral::requireWithin("height", layout.height, 1, std::numeric_limits<int>::max());
  spectral::requireAbove("length of the direction", facing.norm(), 0);
}

void DiffuseConvolution::addRow(int row, const Eigen::Ref<const Eigen::Matrix3Xf>& rgb) {
  spectral::requireWithin("row", row, 0, m_layout.height - 1);
  spectral::requireAsMany("pixels of a row", rgb.cols(), "the width", m_layout.width);
  const double solidAngle = m_layout.solidAngle(row);
  for (int column = 0; column < m_layout.width; ++column) {
    const double weight = solidAngle * std::max(0.0, m_layout.direction(column, row).dot(m_facing));
    m_sum += weight * rgb.col(column).cast<double>();
    m_weight += weight;
  }
}

Eigen::Vector3d DiffuseConvolution::value() const {
  // Divided by the pixels' own sum of cosines, which is pi but for the picture's resolution.
  return m_weight > 0 ? Eigen::Vector3d(m_sum / m_weight) : Eigen::Vector3d(Eigen::Vector3d::Zero());
}

}  // namespace metamer::stage
