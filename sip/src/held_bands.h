// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "metamer/sip/smoothest_spectrum.h"

namespace metamer::sip {

/// What holds a band.
enum class BandState : std::int8_t { Free, AtZero, AtOne };
/// Only the first bandCount states mean anything.
using BandStates = std::array<BandState, kConvergedBandCount>;

BandStates statesOf(const ActiveSet& active, int bandCount);
ActiveSet activeSetOf(const BandStates& states, int bandCount);

/// Behind the bands from `first` on that share its state.
inline int endOfStretch(const BandStates& states, int first, int bandCount) {
  int end = first + 1;
  while (end < bandCount && states[static_cast<std::size_t>(end)] == states[static_cast<std::size_t>(first)]) {
    ++end;
  }
  return end;
}

}  // namespace metamer::sip
