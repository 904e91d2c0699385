// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "lanes.h"

namespace metamer::spectral_ref {

/// Uniform density over the 401 cells.
struct UniformWavelengths {
  /// F^-1(u), its cell and 1/density.
  void sample(float u, float& nm, std::int32_t& cell, float& inverseDensity) const {
    const float x = u * static_cast<float>(kCells);
    cell = std::min(static_cast<std::int32_t>(x), kCells - 1);
    nm = kFirstEdgeNm + x;
    inverseDensity = static_cast<float>(kCells);
  }
};

/// Equiprobable mapping (4.1 with f = p, 4.2.1.2): lane k lies at F^-1(frac(u + k/C)), so that every lane has the
/// hero's density and equal probability lies between neighbours.
template <int C, typename Distribution>
WavelengthSet<C> sampleWavelengths(const Distribution& distribution, float u) {
  WavelengthSet<C> set;
  for (int k = 0; k < C; ++k) {
    float place = u + static_cast<float>(k) / static_cast<float>(C);
    place -= std::floor(place);
    float inverseDensity = 0.0F;
    distribution.sample(std::min(place, 0x1.fffffep-1F), set.nm[k], set.cell[static_cast<std::size_t>(k)],
                        inverseDensity);
    set.weight[k] = inverseDensity / static_cast<float>(C);
  }
  return set;
}

}  // namespace metamer::spectral_ref
