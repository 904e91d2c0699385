// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "metamer/spectral/spectrum.h"

namespace metamer::validation {

/// The leaves among reflectances, by chlorophyll: green, and many times brighter behind the red edge than before it.
std::vector<spectral::Spectrum> foliageAmong(const std::vector<spectral::Spectrum>& samples);

}  // namespace metamer::validation
