// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "metamer/spectral/observer.h"
#include "metamer/spectral/rgb_space.h"

namespace metamer::spectral {

/// One table of data/ as its manifest describes it.
struct ManifestTable {
  std::string file;  ///< relative to the data folder
  std::string group;
  SpectralQuantity quantity = SpectralQuantity::SpectralPowerDistribution;
  std::vector<std::string> names;
  std::string source;
  std::string licence;
  std::string sha256;
  Observer::Response response = Observer::Response::Xyz;
  std::optional<Eigen::Matrix3d> xyzFromResponse;
};

/// Reads manifest.json of a data folder.
/// @throws InputError: missing, malformed, another version, a table without unit or licence
std::vector<ManifestTable> readManifest(const std::filesystem::path& folder);

/// Reads rgb_spaces.json. @throws InputError where it is malformed
std::vector<RgbSpace> readRgbSpaces(const std::filesystem::path& file);

}  // namespace metamer::spectral
