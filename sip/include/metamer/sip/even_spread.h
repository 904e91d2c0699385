// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>

namespace metamer::sip {

/// The plastic number: multiples of its inverse and of its inverse squared, modulo 1, spread evenly over the unit
/// square (Roberts' R2 low-discrepancy sequence).
inline constexpr double kPlasticNumber = 1.32471795724474602596;

/// A point of the unit square brought into a triangle, evenly: the half beyond the diagonal is folded back.
inline Eigen::Vector2d inTriangle(const std::array<Eigen::Vector2d, 3>& corners, double u, double v) {
  if (u + v > 1.0) {
    u = 1.0 - u;
    v = 1.0 - v;
  }
  return corners[0] + u * (corners[1] - corners[0]) + v * (corners[2] - corners[0]);
}

}  // namespace metamer::sip
