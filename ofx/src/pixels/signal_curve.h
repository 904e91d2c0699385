// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "metamer/spectral/log_encoding.h"

namespace metamer::ofx {

/// Light from signal and signal from light on RGBA pixels in place, alpha left alone: in double precision, as the
/// engine's own tools do it.
void decodePixels(spectral::LogEncoding encoding, std::span<float> rgba);
void encodePixels(spectral::LogEncoding encoding, std::span<float> rgba);

/// Takes over from `source` the pixels that have a component that is not finite.
void restoreNonFinite(std::span<const float> source, std::span<float> result);

}  // namespace metamer::ofx
