// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <vector>

#include "metamer/spectral_ref/renderer.h"

namespace metamer::spectral_ref {

/// Writes what guiding has learnt about some pixels as JSON: the density they draw wavelengths from and the histogram.
/// @param pixels  x and y from the top left, within the picture
/// @throws spectral::InputError where the file cannot be written
void writeGuideDump(const Renderer& renderer, const std::vector<std::array<int, 2>>& pixels,
                    const std::filesystem::path& file);

}  // namespace metamer::spectral_ref
