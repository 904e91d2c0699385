// SPDX-License-Identifier: Apache-2.0
#include "metamer/spectral_ref/picture_error.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "metamer/spectral/colorimetry.h"

namespace metamer::spectral_ref {

Eigen::Matrix3d xyzFromColour(const FilmSettings& settings) {
  const bool isXyz = settings.observer.response == spectral::Observer::Response::Xyz;
  const Eigen::Matrix3d xyzFromResponse = isXyz
                                              ? Eigen::Matrix3d(Eigen::Matrix3d::Identity())
                                              : settings.observer.xyzFromResponse.value_or(Eigen::Matrix3d::Identity());
  return xyzFromResponse * settings.colourFromResponse.inverse();
}

double pictureError(const Film& film, const Eigen::Matrix3d& xyzFromColour) {
  const auto& counts = film.replicateCounts();
  if (counts[0] + counts[2] == 0 || counts[1] + counts[3] == 0) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  const std::size_t pixels = film.format().pixels();
  std::vector<double> luminances(pixels);
  for (std::size_t i = 0; i < pixels; ++i) {
    luminances[i] = (xyzFromColour * film.colour(i)).y();
  }
  const auto nth = luminances.begin() + static_cast<std::ptrdiff_t>((pixels - 1) * 99 / 100);
  std::nth_element(luminances.begin(), nth, luminances.end());
  if (!(*nth > 0)) {
    // Almost everywhere black: the brightest pixel, if any, is the white.
    const double most = *std::max_element(luminances.begin(), luminances.end());
    if (!(most > 0)) {
      return 0;
    }
    *nth = most;
  }
  const Eigen::Vector3d white = Eigen::Vector3d::Constant(*nth);
  double sum = 0;
  for (std::size_t i = 0; i < pixels; ++i) {
    const Eigen::Vector3d odd = spectral::lab(xyzFromColour * film.halfColour(i, true), white);
    const Eigen::Vector3d even = spectral::lab(xyzFromColour * film.halfColour(i, false), white);
    sum += spectral::deltaE2000(odd, even);
  }
  return 0.5 * sum / static_cast<double>(pixels);
}

}  // namespace metamer::spectral_ref
