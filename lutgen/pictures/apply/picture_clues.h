// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <string>

#include "apply/any_picture.h"
#include "apply/picture_space.h"

namespace metamer::lutgen {

/// What the header says of a layer's pixels.
SpaceClues cluesOf(const AnyPicture& picture, const ColourLayer& layer);

/// Formats whose pixels are sRGB by what they are, by OpenImageIO's names.
bool isSrgbFormat(const std::string& format);

/// OpenImageIO's name of the format that a file's name asks for; empty: none.
std::string formatOf(const std::filesystem::path& output);

/// xy of red, green, blue, white.
std::array<float, 8> chromaticitiesOf(const spectral::RgbSpace& space);

}  // namespace metamer::lutgen
