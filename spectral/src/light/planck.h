// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

namespace metamer::spectral {

/// Second radiation constant h c / k, in nm K, from the exact SI values (CODATA 2018).
inline constexpr double kSecondRadiationConstantNmK = 6.62607015e-34 * 299792458.0 / 1.380649e-23 * 1e9;

/// exp(c2 / (wavelength temperature)) - 1, the divisor of Planck's law.
inline double planckExponentialTerm(double wavelengthNm, double temperatureK) {
  return std::expm1(kSecondRadiationConstantNmK / (wavelengthNm * temperatureK));
}

}  // namespace metamer::spectral
