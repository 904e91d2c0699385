// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

// Included before everything else where METAMER_STRICT_PATHS is on: text does not become a path without a word, since
// on Windows it would go through a code page. metamer/spectral/path_text.h does it right; string literals are ASCII and
// may.
namespace std::filesystem {

template <>
path::path(const std::string&, path::format) = delete;
template <>
path::path(const std::string_view&, path::format) = delete;
template <>
path& path::operator=(const std::string&) = delete;
template <>
path& path::operator/=(const std::string&) = delete;

}  // namespace std::filesystem
