// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "metamer/sip/homogeneous_map.h"

namespace metamer::sip {

/// A homogeneous map as one square grid over the directions of its front face, for languages whose only table is a cube
/// of 65 nodes a side (DCTL): exact where the transform is one matrix, bilinear elsewhere. What of a pixel
/// lies beyond all lights goes through the matrix, the rest through the grid.
struct ChromaticityGrid {
  static constexpr int kSide = 513;  ///< nodes; kSide^2 of them lie in the cube's 65^3
  static constexpr int kCubeSide = 65;

  /// 9 of the cube of directions from RGB, 9 of the matrix, 24 of its half-spaces, then the least value, the range of
  /// values, the number of half-spaces, 9 of the matrix on coordinates of the cube.
  std::array<float, 54> numbers{};
  /// Of the cube, red fastest, 0 ... 1 over the range of values, as dctlText() writes them; what no node needs is 0.
  std::vector<std::array<float, 3>> nodes;
};

ChromaticityGrid chromaticityGrid(const HomogeneousMap& map);

/// The grid as a DCTL of DaVinci Resolve: `transform` over linear pixels, with controls for exposure, in stops before
/// the transform, and mix.
std::string dctlText(const ChromaticityGrid& grid);

/// What that text makes of RGBA pixels, compiled for the processor, its controls at rest. Alpha is left alone, and so
/// is a pixel that is not finite or beyond 1e37. @throws spectral::InputError for half a pixel
void applyChromaticityGrid(const ChromaticityGrid& grid, std::span<float> rgba);

}  // namespace metamer::sip
