// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "lights/light_sample.h"

namespace metamer::spectral_ref {

/// A light without size. Its intensity takes radiance's place.
struct PointEmitter : NeverHit {
  Vec3 position;

  template <typename Add>
  static void collect(const Scene& scene, const EmbreeScene& /*shapes*/, const Add& add) {
    for (const PointLight& light : scene.points) {
      add(PointEmitter(light.position.cast<float>()), Glow{light.intensity, nullptr}, 1, kNone);
    }
  }
  explicit PointEmitter(const Vec3& place) : position(place) {}

  LightSample located(std::uint32_t /*element*/, float /*u*/, float /*v*/, const Vec3& from) const {
    LightSample sample;
    const Vec3 towards = position - from;
    const float squared = towards.squaredNorm();
    sample.distance = std::sqrt(squared);
    sample.direction = towards / sample.distance;
    sample.scale = 1.0F / squared;
    sample.isDelta = true;
    sample.pdf = squared > 0.0F && sample.scale > 0.0F ? 1.0F : 0.0F;
    return sample;
  }
  static double powerExtent(std::uint32_t /*element*/) { return 4.0 * static_cast<double>(kPi); }
  LightBounds bounds(std::uint32_t /*element*/) const {
    LightBounds bounds;
    bounds.least = position;
    bounds.most = position;
    bounds.spread = kPi;
    bounds.intensity = 1.0F;
    return bounds;
  }
};

}  // namespace metamer::spectral_ref
