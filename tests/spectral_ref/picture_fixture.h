// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace metamer::spectral_ref {

/// Writes an OpenEXR picture of float32 channels in the tests' folder for files.
/// @param values  height x width x channels, top row first
/// @param names   of the channels; none: R, G, B, A
std::filesystem::path exrFile(const std::string& name, int width, int height, int channels,
                              const std::vector<float>& values, const std::vector<std::string>& names = {});

/// The same as a PNG picture of bytes.
std::filesystem::path pngFile(const std::string& name, int width, int height, int channels,
                              const std::vector<std::uint8_t>& values);

}  // namespace metamer::spectral_ref
