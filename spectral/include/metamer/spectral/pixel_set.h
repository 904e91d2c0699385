// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

namespace metamer::spectral {

/// A colour by which files are judged, of data/pixels.
struct SetPixel {
  std::string kind;     ///< "photograph", "noisy photograph", "saturated light", "beyond gamut"
  Eigen::Vector3d rgb;  ///< linear ACEScg
};

/// Reads a table with the columns kind, red, green, blue.
/// @throws InputError: not there, another header, a row that is no kind and three numbers
std::vector<SetPixel> readPixelSet(const std::filesystem::path& file);

}  // namespace metamer::spectral
