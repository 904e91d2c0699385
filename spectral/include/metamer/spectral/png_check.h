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

/// Refuses a PNG that is cut short or damaged before its library sees it, which prints to stderr by itself. Other files
/// pass.
/// @throws InputError naming the byte
void refuseBrokenPng(const std::string& file);

}  // namespace metamer::spectral
