// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "metamer/spectral/spectrum.h"

namespace metamer::spectral {

/// SMPTE ST 2122:2020 spectral similarity index of a light to a reference light, 375 ... 675 nm.
/// @param rounded  to the nearest whole number, as the standard reports it
/// @return at most 100 (equal shapes)
double spectralSimilarityIndex(const Spectrum& light, const Spectrum& reference, bool rounded = true);

}  // namespace metamer::spectral
