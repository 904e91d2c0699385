// SPDX-License-Identifier: Apache-2.0
#include "chain/hexcone.h"

#include <algorithm>
#include <cmath>

namespace metamer::ocio {

Hexcone hexconeOf(const Eigen::Vector3d& rgb) {
  const double most = rgb.maxCoeff();
  const double least = rgb.minCoeff();
  Hexcone result{0.0, 0.0, most + std::min(least, 0.0)};
  const double span = most - least;
  if (span == 0.0) {
    return result;
  }
  result.saturation = -least > most ? span / -least : span / most;
  const double sextant = rgb[0] == most   ? (rgb[1] - rgb[2]) / span
                         : rgb[1] == most ? 2.0 + (rgb[2] - rgb[0]) / span
                                          : 4.0 + (rgb[0] - rgb[1]) / span;
  result.hue = (sextant < 0.0 ? sextant + 6.0 : sextant) / 6.0;
  return result;
}

Eigen::Vector3d colourOf(const Hexcone& hexcone) {
  const auto [hue, saturation, value] = hexcone;
  double most = value;
  double least = value * (1.0 - saturation);
  if (saturation > 1.0) {
    least /= 2.0 - saturation;
    most = value - least;
  }
  if (value < 0.0) {
    least = value / (2.0 - saturation);
    most = value - least;
  }
  const double sextant = 6.0 * (hue - std::floor(hue));
  const Eigen::Vector3d part(std::abs(sextant - 3.0) - 1.0, 2.0 - std::abs(sextant - 2.0),
                             2.0 - std::abs(sextant - 4.0));
  return (least + (most - least) * part.array().max(0.0).min(1.0)).matrix();
}

}  // namespace metamer::ocio
