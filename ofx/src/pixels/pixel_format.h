// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>

namespace metamer::ofx {

enum class Depth { Byte, Short, Half, Float };
enum class Components { Rgba, Rgb, Alpha };

/// How the pixels of an image lie in memory.
struct PixelFormat {
  Depth depth = Depth::Float;
  Components components = Components::Rgba;

  std::size_t channels() const { return components == Components::Rgba ? 4 : components == Components::Rgb ? 3 : 1; }
  std::size_t bytesPerPixel() const;
  bool operator==(const PixelFormat&) const = default;
};

/// From the host's names; nothing for formats that no clip of ours declares.
std::optional<PixelFormat> pixelFormat(const std::string& depth, const std::string& components);

/// Reads `count` pixels as float RGBA. Byte and short are code / 255 and / 65535. RGB has alpha 1; Alpha has colour 0.
void readPixels(const PixelFormat& format, const void* source, std::size_t count, float* rgba);

/// Writes them back. Byte and short are rounded and clamped to the range; half is clamped to +-65504 where finite and
/// rounded to nearest even. A NaN becomes code 0 in byte and short.
void writePixels(const PixelFormat& format, const float* rgba, std::size_t count, void* destination);

}  // namespace metamer::ofx
