// SPDX-License-Identifier: Apache-2.0
#include "pixels/pixel_format.h"

#include <ofxCore.h>
#include <ofxImageEffect.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>

namespace metamer::ofx {
namespace {

constexpr float kLargestHalf = 65504.0F;

template <typename Code>
float decoded(Code code) {
  constexpr auto kLargest = static_cast<float>(std::numeric_limits<Code>::max());
  return static_cast<float>(code) / kLargest;
}
template <>
float decoded<Eigen::half>(Eigen::half code) {
  return static_cast<float>(code);
}
template <>
float decoded<float>(float code) {
  return code;
}

template <typename Code>
Code encoded(float value) {
  constexpr auto kLargest = static_cast<float>(std::numeric_limits<Code>::max());
  // The comparisons also send NaN to 0.
  const float clamped = value > 0.0F ? (value < 1.0F ? value : 1.0F) : 0.0F;
  return static_cast<Code>(clamped * kLargest + 0.5F);
}
template <>
Eigen::half encoded<Eigen::half>(float value) {
  return Eigen::half(std::isfinite(value) ? std::clamp(value, -kLargestHalf, kLargestHalf) : value);
}
template <>
float encoded<float>(float value) {
  return value;
}

/// Rows may start at any byte, so codes are copied, never pointed at.
template <typename Code>
void read(Components components, const void* source, std::size_t count, float* rgba) {
  const auto* bytes = static_cast<const unsigned char*>(source);
  const auto next = [&bytes] {
    Code code;
    std::memcpy(&code, bytes, sizeof code);
    bytes += sizeof code;
    return decoded(code);
  };
  for (std::size_t i = 0; i < count; ++i, rgba += 4) {
    if (components == Components::Alpha) {
      rgba[0] = rgba[1] = rgba[2] = 0.0F;
      rgba[3] = next();
      continue;
    }
    for (int k = 0; k < 3; ++k) {
      rgba[k] = next();
    }
    rgba[3] = components == Components::Rgba ? next() : 1.0F;
  }
}

template <typename Code>
void write(Components components, const float* rgba, std::size_t count, void* destination) {
  auto* bytes = static_cast<unsigned char*>(destination);
  const auto put = [&bytes](float value) {
    const Code code = encoded<Code>(value);
    std::memcpy(bytes, &code, sizeof code);
    bytes += sizeof code;
  };
  for (std::size_t i = 0; i < count; ++i, rgba += 4) {
    if (components != Components::Alpha) {
      for (int k = 0; k < 3; ++k) {
        put(rgba[k]);
      }
    }
    if (components != Components::Rgb) {
      put(rgba[3]);
    }
  }
}

}  // namespace

std::size_t PixelFormat::bytesPerPixel() const {
  const std::size_t bytes = depth == Depth::Byte ? 1 : depth == Depth::Float ? 4 : 2;
  return bytes * channels();
}

std::optional<PixelFormat> pixelFormat(const std::string& depth, const std::string& components) {
  PixelFormat format;
  if (depth == kOfxBitDepthByte) {
    format.depth = Depth::Byte;
  } else if (depth == kOfxBitDepthShort) {
    format.depth = Depth::Short;
  } else if (depth == kOfxBitDepthHalf) {
    format.depth = Depth::Half;
  } else if (depth != kOfxBitDepthFloat) {
    return std::nullopt;
  }
  if (components == kOfxImageComponentRGB) {
    format.components = Components::Rgb;
  } else if (components == kOfxImageComponentAlpha) {
    format.components = Components::Alpha;
  } else if (components != kOfxImageComponentRGBA) {
    return std::nullopt;
  }
  return format;
}

void readPixels(const PixelFormat& format, const void* source, std::size_t count, float* rgba) {
  switch (format.depth) {
    case Depth::Byte:
      return read<std::uint8_t>(format.components, source, count, rgba);
    case Depth::Short:
      return read<std::uint16_t>(format.components, source, count, rgba);
    case Depth::Half:
      return read<Eigen::half>(format.components, source, count, rgba);
    case Depth::Float:
      if (format.components == Components::Rgba) {
        std::memcpy(rgba, source, count * format.bytesPerPixel());
        return;
      }
      return read<float>(format.components, source, count, rgba);
  }
}

void writePixels(const PixelFormat& format, const float* rgba, std::size_t count, void* destination) {
  switch (format.depth) {
    case Depth::Byte:
      return write<std::uint8_t>(format.components, rgba, count, destination);
    case Depth::Short:
      return write<std::uint16_t>(format.components, rgba, count, destination);
    case Depth::Half:
      return write<Eigen::half>(format.components, rgba, count, destination);
    case Depth::Float:
      if (format.components == Components::Rgba) {
        std::memcpy(destination, rgba, count * format.bytesPerPixel());
        return;
      }
      return write<float>(format.components, rgba, count, destination);
  }
}

}  // namespace metamer::ofx
