// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include "geometry/ray_group.h"
#include "integrator/path_random.h"
#include "integrator/reservoir.h"
#include "lights/light_tree.h"
#include "materials/bsdf.h"
#include "wavelengths/lanes.h"

namespace metamer::spectral_ref {

/// What a path starts with.
template <int C>
struct PathStart {
  PathRandom random;
  WavelengthSet<C> wavelengths;
};

/// Paths that are followed side by side, those of neighbouring pixels: which ones, depends on the picture alone.
template <int C>
struct PathStarts {
  std::size_t count = 0;
  std::array<PathStart<C>, kRaysTogether> paths;
  RayGroup rays;
};

/// What a path has become on its way from the camera.
template <int C, bool kDispersive>
struct Path {
  static Density<C, kDispersive> ones() {
    if constexpr (kDispersive) {
      return Lanes<C>::Ones();
    } else {
      return 1.0F;
    }
  }

  /// Starts anew from the camera.
  void begin(const WavelengthSet<C>& wavelengths) {
    radiance.setZero();
    throughput.setOnes();
    heroes = ones();
    lanes = wavelengths;
    heroSum = static_cast<float>(C);
    heroSumBefore = static_cast<float>(C);
    resampled = nullptr;
    lastIsDelta = true;
  }

  Lanes<C> radiance = Lanes<C>::Zero();
  /// Product of BSDFs and cosines over the density of the path's directions with the hero that drew them.
  Lanes<C> throughput = Lanes<C>::Ones();
  /// Light that a surface sends on if nothing lies in its way.
  Lanes<C> direct = Lanes<C>::Zero();
  /// The same density with each lane as hero, over that of the hero.
  Density<C, kDispersive> heroes = ones();
  WavelengthSet<C> lanes{};                       ///< that it carries here: fluorescent surfaces shift them
  float heroSum = static_cast<float>(C);          ///< over all heroes
  float heroSumBefore = static_cast<float>(C);    ///< the same before the last direction was drawn
  float lastPdf = 0;                              ///< of that direction, by the hero
  const ReservoirDomain<C>* resampled = nullptr;  ///< where its next-event estimation was resampled
  LitPoint last;
  std::uint32_t emitter = 0;  ///< that the direct light comes from
  bool lastIsDelta = true;    ///< next-event estimation could not have found what it hits
};

/// Paths that are followed side by side. One serves many groups, one after another: it takes time to set up.
template <int C, bool kDispersive>
struct PathGroup {
  std::array<Path<C, kDispersive>, kRaysTogether> paths;
  RayGroup rays;  ///< the paths' next edges
  HitGroup hits;
  RayGroup shadowRays;   ///< to where a path's direct light comes from
  RayMask lit = 0;       ///< paths that have such light
  RayMask absorbed = 0;  ///< paths that a gel has ended
};

}  // namespace metamer::spectral_ref
