// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <OpenImageIO/imagebuf.h>

#include <array>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "metamer/stage/picture_view.h"

namespace metamer::lutgen {

/// Channels R, G, B by name, in whatever order; else the first three.
/// @throws spectral::InputError where there are not three
std::array<int, 3> colourChannels(const OIIO::ImageSpec& spec, const std::string& file);

/// A picture in memory as float, with its metadata, windows and every channel.
class Picture {
 public:
  /// @throws spectral::InputError: cannot be read, several parts, deep, no three colour channels
  explicit Picture(const std::filesystem::path& file);

  int width() const { return m_pixels.spec().width; }
  /// Rows, those of every slice of a volume.
  int height() const { return m_pixels.spec().height * m_pixels.spec().depth; }
  /// All pixels as RGBA, row by row, alpha 1.
  std::vector<float> rgba() const;
  /// Whether the file says, or its format implies, that the pixels are encoded as sRGB.
  bool isSrgb() const;

  /// The pixels where they lie, good as long as this is; of a volume the first slice.
  stage::PictureView view() const;

  const OIIO::ImageBuf& pixels() const { return m_pixels; }
  const std::array<int, 3>& colours() const { return m_colours; }

 private:
  OIIO::ImageBuf m_pixels;
  std::array<int, 3> m_colours{};  ///< channels of red, green, blue
};

/// Writes pixels whole or not at all. @param field  what messages call the picture
/// @param format  of OpenImageIO; by the extension where empty
/// @throws spectral::InputError
void writePixels(const OIIO::ImageBuf& pixels, const std::filesystem::path& file, const OIIO::TypeDesc& type,
                 const std::string& field, const std::string& format = {});

/// The sRGB curve (IEC 61966-2-1) undone on the colours of RGBA pixels, in place.
void decodeSrgb(std::span<float> rgba);

}  // namespace metamer::lutgen
