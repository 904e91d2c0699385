// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace metamer::spectral_ref {

/// Writes an OpenEXR picture of float32 channels in the tests' folder for files.
/// @param values  height x width x channels, top row first
std::filesystem::path exrFile(const std::string& name, int width, int height, int channels,
                              const std::vector<float>& values);

}  // namespace metamer::spectral_ref
