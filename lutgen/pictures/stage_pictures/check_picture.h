// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "metamer/stage/chart_grid.h"
#include "picture.h"

namespace metamer::lutgen {

/// Draws the squares that are averaged into a copy of the picture, made to be looked at: exposed so that the brightest
/// square is white, with the sRGB curve. The first patch's square has a cross.
/// @throws spectral::InputError where the file cannot be written
void writeCheckPicture(const Picture& picture, const stage::ChartGrid& grid, const std::filesystem::path& file);

}  // namespace metamer::lutgen
