// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "metamer/ocio/bake.h"
#include "metamer/ocio/certificate.h"
#include "metamer/sip/recipe.h"
#include "metamer/spectral/data_library.h"

namespace metamer::ocio {

struct ConfigOptions {
  std::filesystem::path base;  ///< config to add to; empty: a new one
  /// Whether looks of the base that have a recipe's name are made anew, with their named transforms and files, in their
  /// places. Without a base, `file` is the base where it is there.
  bool replaces = false;
  std::string lutFolder = "luts";  ///< beside the config, one name
  std::string name;                ///< of a new config; empty: the file's stem
  std::string description;         ///< of a new config
  std::string family = "metamer";  ///< of the named transforms, above what they change
  /// Nodes along a side of the tables, kSmallestTable ... kLargestTable (log_cube.h), the most with a tolerance; 0: 65.
  int size = 0;
  /// 99th percentile of CIEDE2000 to hold with the least: nothing, a matrix, a table of few nodes, of more. Where none
  /// up to `size` does, the largest is taken (above 0); the certificate says what it holds.
  std::optional<double> tolerance;
  std::function<void(double share)> progress;  ///< as BakeOptions
};

/// What one recipe became.
struct ConfigEntry {
  std::string name;          ///< of its look; that of its named transform is "NAME - Transform"
  std::string processSpace;  ///< of the look
  std::string pixelSpace;    ///< what the named transform is applied to
  std::string file;          ///< its LUT file, relative to the config's folder; empty where it has none
  Certificate certificate;
};

struct ConfigReport {
  std::vector<ConfigEntry> entries;
  /// Whether the OCIO at hand has loaded the result and built every look and named transform. It cannot where the base
  /// has a later profile than it knows; what is added is then checked in a new config.
  bool isLoaded = false;
  int majorVersion = 0;  ///< profile of the result
  int minorVersion = 0;
  std::vector<std::string> unused;  ///< files that replaced looks had and no transform reads any more
};

/// Writes a config with a look and a named transform a recipe, their LUT files (.ctf, the exposure-invariant chain) and
/// a certificate beside each, `LUTFOLDER/NAME.json`. All files appear or none.
///
/// A new config has OCIO profile 2.1. A base keeps its text byte for byte: looks and named transforms are added at the
/// end of their lists, and the LUT folder at the end of its search path. No file that the base reads is written over,
/// but for those of replaced looks alone. A look works in the linear
/// part of its recipe's space where the config has it, else in the space of the role aces_interchange. Recipes that
/// differ in nothing but adaptation share a LUT file: what follows it is then one matrix.
/// @throws spectral::InputError: the base is not there, no config, of profile 1, lacks aces_interchange, names files
///         that are not found from the new place, has one of the names; a recipe; a place that cannot be written
ConfigReport writeConfig(const std::vector<sip::Recipe>& recipes, const spectral::DataLibrary& library,
                         const std::filesystem::path& file, const ConfigOptions& options = {});

/// The certificate that writeConfig() left for a look; empty where none is found.
/// @throws spectral::InputError where the config cannot be read
std::filesystem::path certificateOfLook(const std::filesystem::path& config, const std::string& look);

}  // namespace metamer::ocio
