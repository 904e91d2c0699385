// SPDX-License-Identifier: Apache-2.0
#include "metamer/spectral/rgb_space.h"

#include <Eigen/LU>

#include "metamer/spectral/colorimetry.h"

namespace metamer::spectral {

Eigen::Vector3d RgbSpace::whiteXyz() const {
  return xyzFromChromaticity(white);
}

Eigen::Matrix3d RgbSpace::xyzFromRgb() const {
  Eigen::Matrix3d directions;
  for (Eigen::Index k = 0; k < 3; ++k) {
    const Eigen::Vector2d& xy = primaries[static_cast<std::size_t>(k)];
    // Not scaled to Y = 1: a primary with y = 0 is allowed.
    directions.col(k) << xy.x(), xy.y(), 1.0 - xy.x() - xy.y();
  }
  const Eigen::Vector3d amounts = directions.fullPivLu().solve(whiteXyz());
  return directions * amounts.asDiagonal();
}

Eigen::Matrix3d RgbSpace::rgbFromXyz() const {
  return xyzFromRgb().inverse();
}

}  // namespace metamer::spectral
