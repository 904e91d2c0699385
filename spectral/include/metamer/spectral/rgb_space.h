// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <string>

namespace metamer::spectral {

/// A linear RGB space by its primaries and white, chromaticities CIE 1931.
struct RgbSpace {
  std::string name;
  std::array<Eigen::Vector2d, 3> primaries;  ///< xy of red, green, blue
  Eigen::Vector2d white;                     ///< xy

  /// White with Y = 1.
  Eigen::Vector3d whiteXyz() const;
  /// Derived from primaries and white (SMPTE RP 177), never from rounded published matrices.
  Eigen::Matrix3d xyzFromRgb() const;
  Eigen::Matrix3d rgbFromXyz() const;
};

}  // namespace metamer::spectral
