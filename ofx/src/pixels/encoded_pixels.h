// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <span>

#include "metamer/spectral/log_encoding.h"
#include "pixels/signal_table.h"

namespace metamer::ofx {

/// What is done to linear RGBA pixels, from one span to another, which may be the same.
using LinearPixels = std::function<void(std::span<const float>, std::span<float>)>;

/// Does it to encoded ones: decoded before, encoded after; what is not finite is put back.
/// @param table  of the encoding, for speed; null: by the curve itself
void throughEncoding(spectral::LogEncoding encoding, const SignalTable* table, std::span<const float> source,
                     std::span<float> destination, const LinearPixels& linear);

}  // namespace metamer::ofx
