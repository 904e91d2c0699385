// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <type_traits>

#include "geometry/geometry.h"
#include "wavelengths/lanes.h"

namespace metamer::spectral_ref {

/// A density by which a direction is drawn: one number, or, where scattering depends on wavelength (`kDispersive`), one
/// a lane: the density had that lane been the hero.
template <int C, bool kDispersive>
using Density = std::conditional_t<kDispersive, Lanes<C>, float>;

/// Sum over the lanes as heroes: the denominators of (4.7) and (4.10).
template <int C>
float sumOverHeroes(float density) {
  return static_cast<float>(C) * density;
}
template <int C>
float sumOverHeroes(const Lanes<C>& density) {
  return density.sum();
}
inline float heroDensity(float density) {
  return density;
}
template <int C>
float heroDensity(const Lanes<C>& density) {
  return density[0];
}

/// A density that does not depend on the hero.
template <int C, bool kDispersive>
Density<C, kDispersive> sameForAll(float density) {
  if constexpr (kDispersive) {
    return Lanes<C>::Constant(density);
  } else {
    return density;
  }
}

/// A BSDF for two directions, in the frame of the surface.
template <int C, bool kDispersive>
struct BsdfValue {
  Lanes<C> value = Lanes<C>::Zero();                               ///< BSDF times |cos| of the incident direction
  Density<C, kDispersive> pdf = sameForAll<C, kDispersive>(0.0F);  ///< of drawing that direction, per steradian
};

/// A direction drawn from a BSDF.
template <int C, bool kDispersive>
struct BsdfSample {
  Vec3 direction = Vec3::Zero();       ///< local frame, away from the surface
  Lanes<C> weight = Lanes<C>::Zero();  ///< BSDF times |cos| over the hero's density
  Density<C, kDispersive> pdf =
      sameForAll<C, kDispersive>(0.0F);  ///< of a delta: probability of the choice, 0 for lanes that would go elsewhere
  bool isDelta = false;
};

}  // namespace metamer::spectral_ref
