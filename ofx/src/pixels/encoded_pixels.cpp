// SPDX-License-Identifier: Apache-2.0
#include "pixels/encoded_pixels.h"

#include <algorithm>
#include <array>

#include "pixels/signal_curve.h"

namespace metamer::ofx {

namespace {

/// Encoded pixels are worked on in parts, beside a copy of the part: what is not finite is put back.
constexpr std::size_t kPartFloats = 2048;

void partThroughEncoding(spectral::LogEncoding encoding, const SignalTable* table, std::span<const float> source,
                         std::span<float> destination, const LinearPixels& linear) {
  std::array<float, kPartFloats> memory;
  const std::span<float> part(memory.data(), source.size());
  std::copy(source.begin(), source.end(), part.begin());
  if (table != nullptr) {
    table->decode(part);
    linear(part, part);
    table->encode(part);
  } else {
    decodePixels(encoding, part);
    linear(part, part);
    encodePixels(encoding, part);
  }
  restoreNonFinite(source, part);
  std::copy(part.begin(), part.end(), destination.begin());
}

}  // namespace

void throughEncoding(spectral::LogEncoding encoding, const SignalTable* table, std::span<const float> source,
                     std::span<float> destination, const LinearPixels& linear) {
  for (std::size_t begin = 0; begin < source.size(); begin += kPartFloats) {
    const std::size_t count = std::min(kPartFloats, source.size() - begin);
    partThroughEncoding(encoding, table, source.subspan(begin, count), destination.subspan(begin, count), linear);
  }
}

}  // namespace metamer::ofx
