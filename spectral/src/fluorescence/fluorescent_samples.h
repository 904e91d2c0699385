// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "metamer/spectral/reradiation.h"

namespace metamer::spectral {

/// Photons of each excitation that come back at other wavelengths, for each that arrives.
ExcitationSamples photonsShifted(const FluorescentSamples& surface);

/// Lowers reflectance (and, where rounding asks for it, re-radiation) to what leaves no more photons than arrive.
void keepBalance(FluorescentSamples& surface);

/// Of a spectrum, linear between its wavelengths.
double integralOf(const Spectrum& spectrum);

}  // namespace metamer::spectral
