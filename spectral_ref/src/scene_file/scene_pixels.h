// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "metamer/spectral/spectrum.h"
#include "scene_file/scene_value.h"

namespace metamer::spectral_ref {

/// A picture that a scene names, as it lies in its file.
struct Pixels {
  int width = 0;
  int height = 0;
  int channels = 0;
  std::vector<std::string> names;
  bool isFloat = false;       ///< else whole numbers, 1 the largest
  std::vector<float> values;  ///< height x width x channels, top row first, finite
};

/// @throws spectral::InputError: no picture, an empty, deep or very large one, a value that is no finite number
Pixels readPixels(const YamlValue& value, const std::filesystem::path& folder);

/// A spectral picture's channels by rising wavelength: nanometres, and which it is. Empty: it is none.
std::vector<std::pair<double, int>> spectralChannels(const Pixels& pixels, spectral::SpectralQuantity quantity);

}  // namespace metamer::spectral_ref
