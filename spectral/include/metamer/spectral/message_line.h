// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace metamer::spectral {

/// The longest line that a program says of a failure, in bytes.
inline constexpr std::size_t kLongestMessage = 300;

/// A message, also of another library, as one line for people: line ends and runs of spaces become one space, places in
/// the sources of whoever built a library go, and a text that is too long loses its middle.
/// @param most  bytes
std::string messageLine(std::string_view message, std::size_t most = kLongestMessage);

}  // namespace metamer::spectral
