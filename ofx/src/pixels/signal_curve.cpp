// SPDX-License-Identifier: Apache-2.0
#include "pixels/signal_curve.h"

#include <algorithm>
#include <cmath>

namespace metamer::ofx {

void decodePixels(spectral::LogEncoding encoding, std::span<float> rgba) {
  for (std::size_t i = 0; i < rgba.size(); ++i) {
    if (i % 4 != 3) {
      rgba[i] = static_cast<float>(spectral::decode(encoding, rgba[i]));
    }
  }
}

void encodePixels(spectral::LogEncoding encoding, std::span<float> rgba) {
  for (std::size_t i = 0; i < rgba.size(); ++i) {
    if (i % 4 != 3) {
      rgba[i] = static_cast<float>(spectral::encode(encoding, rgba[i]));
    }
  }
}

void restoreNonFinite(std::span<const float> source, std::span<float> result) {
  for (std::size_t i = 0; i < source.size(); i += 4) {
    if (!std::isfinite(source[i]) || !std::isfinite(source[i + 1]) || !std::isfinite(source[i + 2])) {
      std::copy_n(source.data() + i, 3, result.data() + i);
    }
  }
}

}  // namespace metamer::ofx
