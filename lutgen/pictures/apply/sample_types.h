// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <OpenImageIO/imageio.h>

namespace metamer::lutgen {

// Samples of a pixel that may have a type a channel.

inline OIIO::TypeDesc typeOf(const OIIO::ImageSpec& spec, int channel) {
  return spec.channelformat(channel);
}

inline std::size_t offsetOf(const OIIO::ImageSpec& spec, int channel) {
  std::size_t offset = 0;
  for (int c = 0; c < channel; ++c) {
    offset += typeOf(spec, c).size();
  }
  return offset;
}

/// Types that OpenEXR holds as they are.
inline bool isExrType(OIIO::TypeDesc type) {
  return type == OIIO::TypeDesc::HALF || type == OIIO::TypeDesc::FLOAT || type == OIIO::TypeDesc::UINT32;
}

}  // namespace metamer::lutgen
