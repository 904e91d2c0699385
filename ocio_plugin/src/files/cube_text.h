// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "metamer/ocio/lut_writer.h"

namespace metamer::ocio {

/// A 3-D table as the text of a cube file: two formats that share an extension and little else.
/// @param rgba  size^3 nodes of four floats, red fastest; the fourth is left out
/// Iridas (Adobe): TITLE, LUT_3D_SIZE, DOMAIN_MIN and DOMAIN_MAX.
std::string iridasCubeText(std::span<const float> rgba, int size, const LutDescription& description);
/// Resolve: LUT_3D_SIZE and LUT_3D_INPUT_RANGE, and the same of a curve before it where there is one.
/// @param shaperCurve  entries of four floats over 0 ... 1; none: no curve
std::string resolveCubeText(std::span<const float> shaperCurve, std::span<const float> rgba, int size,
                            const LutDescription& description);
/// Imageworks' spi3d, which has no place for comments; OCIO's baker writes it from 2.4 on alone.
std::string spi3dText(std::span<const float> rgba, int size);
/// Imageworks' spi1d: curves over 0 ... 1. @param rgba  entries of four floats; the fourth is left out
std::string spi1dText(std::span<const float> rgba);

}  // namespace metamer::ocio
