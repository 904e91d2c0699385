// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "metamer/spectral/spectrum.h"

namespace metamer::spectral {

/// Blackbody radiator by Planck's law (CODATA 2018 constants), relative, 1 at 560 nm, 300-830 nm every 1 nm.
/// @param temperatureK  500 ... 100000 K
/// @throws InputError outside that range
Spectrum blackbody(double temperatureK);

/// CIE daylight of a correlated colour temperature (CIE 015:2018, eq. 4.7 to 4.11), relative, 1 at 560 nm,
/// 300-830 nm every 5 nm.
/// @param cctK  4000 ... 25000 K, nominal (no 1.4388/1.4380 rescaling: give 6504 for D65)
/// @param basis the table of the components S0, S1, S2 (columns of 3) from data/
/// @throws InputError outside that range, or where the basis is not three
Spectrum daylight(double cctK, const std::vector<Spectrum>& basis);

}  // namespace metamer::spectral
