// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "metamer/spectral/vector_lanes.h"
#include "wavelengths/lanes.h"

namespace metamer::spectral_ref {

/// Uniform density over the 401 cells.
struct UniformWavelengths {
  /// F^-1(u), its cell and 1/density.
  METAMER_ALWAYS_INLINE void sample(float u, float& nm, std::int32_t& cell, float& inverseDensity) const {
    const float x = u * static_cast<float>(kCells);
    cell = std::min(static_cast<std::int32_t>(x), kCells - 1);
    nm = kFirstEdgeNm + x;
    inverseDensity = static_cast<float>(kCells);
  }
};

/// What samples of a stratified `u` are spread evenly over the spectrum by.
enum class Spread {
  Lanes,  ///< all lanes together: n samples fall into n C strata, best where the hero is a lane like the others
  Hero,   ///< the hero alone: n samples, n strata; for scenes in which the hero decides what light is found
};

/// Equiprobable mapping (4.1 with f = p, 4.2.1.2): lanes lie at F^-1(frac(u' + k/C)), so that every lane has the hero's
/// density and equal probability lies between neighbours.
///
/// With Spread::Hero u' is u. But the set of places has period 1/C in u': so with Spread::Lanes the leading bits of u,
/// those that are stratified, choose the place within one period, and the last ones which of the lanes is the hero.
/// @param u  0 ... 1, a multiple of 2^-24
template <int C, typename Distribution>
METAMER_ALWAYS_INLINE WavelengthSet<C> sampleWavelengths(const Distribution& distribution, float u,
                                                         Spread spread = Spread::Lanes) {
  constexpr auto kLanes = static_cast<std::uint32_t>(C);
  constexpr std::uint32_t kUnits = 1U << 24U;
  constexpr std::uint32_t kPeriod = kUnits / kLanes;
  const auto bits = static_cast<std::uint32_t>(u * static_cast<float>(kUnits));
  const std::uint32_t hero = spread == Spread::Hero ? bits : bits / kLanes + bits % kLanes * kPeriod;
  WavelengthSet<C> set;
  for (std::uint32_t k = 0; k < kLanes; ++k) {
    const std::uint32_t place = (hero + k * kPeriod) % kUnits;
    float inverseDensity = 0.0F;
    distribution.sample(static_cast<float>(place) * 0x1p-24F, set.nm[k], set.cell[k], inverseDensity);
    set.weight[k] = inverseDensity / static_cast<float>(C);
  }
  return set;
}

}  // namespace metamer::spectral_ref
