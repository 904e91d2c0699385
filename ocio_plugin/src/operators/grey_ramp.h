// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "metamer/ocio/pixel_processor.h"

namespace metamer::ocio {

/// What a transform makes of `count` greys, evenly spread over 0 ... 1: four floats each.
inline std::vector<float> greyRamp(const OCIO::ConstTransformRcPtr& transform, int count) {
  std::vector<float> rgba;
  rgba.reserve(4 * static_cast<std::size_t>(count));
  for (int k = 0; k < count; ++k) {
    const auto at = static_cast<float>(static_cast<double>(k) / (count - 1));
    rgba.insert(rgba.end(), {at, at, at, 1.0F});
  }
  PixelProcessor(transform).apply(rgba);
  return rgba;
}

}  // namespace metamer::ocio
