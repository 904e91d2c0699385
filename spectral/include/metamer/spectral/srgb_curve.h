// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

namespace metamer::spectral {

/// The curve of sRGB (IEC 61966-2-1), mirrored below zero and continued above one.
/// @param linear  light, 1 the screen's white. @return the signal, 1 the largest code
inline double srgbFromLinear(double linear) {
  const double size = std::abs(linear);
  return std::copysign(size <= 0.0031308 ? 12.92 * size : 1.055 * std::pow(size, 1.0 / 2.4) - 0.055, linear);
}

/// Undone: light from signal.
inline double linearFromSrgb(double signal) {
  const double size = std::abs(signal);
  return std::copysign(size <= 0.04045 ? size / 12.92 : std::pow((size + 0.055) / 1.055, 2.4), signal);
}

}  // namespace metamer::spectral
