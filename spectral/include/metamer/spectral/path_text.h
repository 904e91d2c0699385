// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

// Text is UTF-8 everywhere in metamer, and so are the names of files in it. A path's own conversions go through a code
// page on Windows, which loses what that cannot hold: these two are the only way between text and paths
// (tests/sources).
namespace metamer::spectral {

/// A path as UTF-8. Where names are bytes, these bytes.
std::string utf8(const std::filesystem::path& path);

/// The path that UTF-8 names. Where names are bytes, these bytes.
std::filesystem::path pathOf(std::string_view text);

}  // namespace metamer::spectral
