// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bitset>

#include "metamer/sip/band_weights.h"

namespace metamer::sip {

/// The bands that a spectrum has below zero, a bit a band. With them given, the spectrum is linear in the tristimulus.
using ClampedBands = std::bitset<kConvergedBandCount>;

}  // namespace metamer::sip
