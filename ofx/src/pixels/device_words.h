// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstdint>
#include <vector>

#include "metamer/spectral/log_pieces.h"

namespace metamer::ofx {

/// Doubles among a kernel's cells: two words each, the lower first, as devices have them in memory.
inline void appendDouble(std::vector<std::uint32_t>& words, double value) {
  const auto bits = std::bit_cast<std::uint64_t>(value);
  words.push_back(static_cast<std::uint32_t>(bits));
  words.push_back(static_cast<std::uint32_t>(bits >> 32U));
}

/// A curve's pieces in the order in which the kernels' text names them.
inline void appendPieces(std::vector<std::uint32_t>& words, const spectral::LogPieces& pieces) {
  for (const auto& logarithm : {pieces.above, pieces.below}) {
    for (const double value : {logarithm.gain, logarithm.shift, logarithm.scale, logarithm.offset}) {
      appendDouble(words, value);
    }
  }
  for (const double value :
       {pieces.lightAbove, pieces.signalAbove, pieces.lightBelow, pieces.signalBelow, pieces.slope}) {
    appendDouble(words, value);
  }
}

}  // namespace metamer::ofx
