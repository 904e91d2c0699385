// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "config/config_document.h"

namespace metamer::ocio {

/// A config to add to: a file, or one of OCIO's own by name (ocio://default).
/// @param result  the config that will be written: the base's files must be found from there too
/// @throws spectral::InputError: not there, an archive, no config, profile 1, no role
///         aces_interchange, a file that is not found
ConfigDocument openBaseConfig(const std::filesystem::path& base, const std::filesystem::path& result);

/// Where a config at a place finds our files.
struct LutPlace {
  std::string prefix;        ///< before a file's name in src
  std::string searchFolder;  ///< to add to the search path; empty: nothing
};
LutPlace placeOfLuts(const ConfigFacts& facts, const std::string& folder);

/// @throws spectral::InputError where an earlier folder of the search path has a file of this name
void refuseShadows(const ConfigFacts& facts, const std::string& src, const std::string& lutFolder,
                   const std::filesystem::path& result);

}  // namespace metamer::ocio
