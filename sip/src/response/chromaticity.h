// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace metamer::sip {

/// Of white's mean response: what is darker under a light has no chromaticity to speak of.
inline constexpr double kDarkestMean = 1e-4;

/// Whether a colour has a chromaticity that surfaces could have: one whose mean is no larger a part of its largest
/// channel lies beyond all lights.
inline bool hasChromaticity(const Eigen::Vector3d& response) {
  constexpr double kLeastMean = 1e-4;
  return response.mean() > kLeastMean * response.cwiseAbs().maxCoeff();
}

/// How a place `differences * response / mean` changes with the response.
/// @param place  of a response with that mean
inline Eigen::Matrix<double, 2, 3> placeSlope(const Eigen::Matrix<double, 2, 3>& differences,
                                              const Eigen::Vector2d& place, double mean) {
  return differences / mean - place * Eigen::RowVector3d::Constant(1.0 / (3.0 * mean));
}

}  // namespace metamer::sip
