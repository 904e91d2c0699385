// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace metamer::spectral {

/// What a PNG begins with.
inline constexpr std::string_view kPngSignature("\x89PNG\r\n\x1a\n", 8);

/// A number of four bytes as PNG writes it, most significant first.
std::uint32_t bigEndian(const char* bytes);

/// Refuses what no library of pictures must see: a folder, a pipe or a device, which may never end, and a PNG that is
/// cut short or damaged, of which its library prints to stderr by itself. Other files pass, and one that is not there.
/// @throws InputError, of a PNG naming the byte
void requirePictureFile(const std::string& file);

}  // namespace metamer::spectral
