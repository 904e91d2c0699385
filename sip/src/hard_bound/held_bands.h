// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>

#include "metamer/sip/smoothest_spectrum.h"

namespace metamer::sip {

/// What holds a band.
enum class BandState : std::int8_t { Free, AtZero, AtOne };

/// States read at once by endOfStretch().
inline constexpr std::size_t kStatesAWord = sizeof(std::uint64_t);

/// Only the first bandCount states mean anything; room behind the last for a word that begins there.
using BandStates = std::array<BandState, kConvergedBandCount + kStatesAWord>;

BandStates statesOf(const ActiveSet& active);
ActiveSet activeSetOf(const BandStates& states, int bandCount);

/// Of a word of states' differences, not all zero: the first that is not.
inline int firstOther(std::uint64_t differences) {
  const int bit =
      std::endian::native == std::endian::little ? std::countr_zero(differences) : std::countl_zero(differences);
  return bit / 8;
}

/// Behind the bands from `first` on that share its state.
inline int endOfStretch(const BandStates& states, int first, int bandCount) {
  constexpr std::uint64_t kEachByte = 0x0101010101010101U;
  const std::uint64_t same = kEachByte * static_cast<std::uint8_t>(states[static_cast<std::size_t>(first)]);
  for (int band = first; band < bandCount; band += static_cast<int>(kStatesAWord)) {
    std::uint64_t word = 0;
    std::memcpy(&word, states.data() + band, kStatesAWord);
    if (word != same) {
      return std::min(band + firstOther(word ^ same), bandCount);
    }
  }
  return bandCount;
}

}  // namespace metamer::sip
