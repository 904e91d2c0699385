// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>

// Half floats by their definition (IEEE 754 binary16), for tests: slow, and told by arithmetic alone, so that they
// share nothing with what they check.
namespace photo_host {

inline float floatFromHalf(std::uint16_t code) {
  const int exponent = code >> 10 & 31;
  const int mantissa = code & 1023;
  const float sign = (code & 0x8000) != 0 ? -1.0F : 1.0F;
  if (exponent == 31) {
    return mantissa == 0 ? sign * std::numeric_limits<float>::infinity() : std::numeric_limits<float>::quiet_NaN();
  }
  return exponent == 0 ? sign * std::ldexp(static_cast<float>(mantissa), -24)
                       : sign * std::ldexp(static_cast<float>(mantissa + 1024), exponent - 25);
}

/// The nearest; ties to even; beyond the range infinite.
inline std::uint16_t halfFromFloat(float value) {
  const std::uint16_t sign = std::signbit(value) ? 0x8000 : 0;
  if (std::isnan(value)) {
    return static_cast<std::uint16_t>(sign | 0x7e00);
  }
  const double magnitude = std::fabs(static_cast<double>(value));
  int exponent = magnitude > 0 ? std::ilogb(magnitude) : -15;
  exponent = exponent < -14 ? -14 : exponent;
  if (exponent > 15) {
    return static_cast<std::uint16_t>(sign | 0x7c00);
  }
  const auto steps = static_cast<int>(std::nearbyint(std::ldexp(magnitude, 10 - exponent)));
  // Steps of 2048 carry into the exponent by themselves.
  return static_cast<std::uint16_t>(sign | (((exponent + 14) << 10) + steps));
}

}  // namespace photo_host
