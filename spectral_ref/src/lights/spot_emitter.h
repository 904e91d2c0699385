// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "lights/point_emitter.h"

namespace metamer::spectral_ref {

/// A point light that shines into a cone, evenly within a narrower one, with a smooth step between.
struct SpotEmitter : NeverHit {
  PointEmitter lamp;
  Vec3 direction;
  float cosCone = 0;
  float cosBeam = 0;

  template <typename Add>
  static void collect(const Scene& scene, const EmbreeScene& /*shapes*/, const Add& add) {
    const auto cosine = [](double degrees) { return static_cast<float>(std::cos(degrees * kRadiansADegree)); };
    for (const SpotLight& light : scene.spots) {
      SpotEmitter emitter(light.position.cast<float>());
      emitter.direction = light.direction.normalized().cast<float>();
      emitter.cosCone = cosine(light.coneDegrees);
      emitter.cosBeam = cosine(light.beamDegrees);
      add(emitter, Glow{light.intensity, nullptr}, 1, kNone);
    }
  }
  explicit SpotEmitter(const Vec3& place) : lamp(place) {}

  LightSample located(std::uint32_t element, float u, float v, const Vec3& from) const {
    LightSample sample = lamp.located(element, u, v, from);
    const float cosine = -sample.direction.dot(direction);
    const float t = std::clamp((cosine - cosCone) / (cosBeam - cosCone), 0.0F, 1.0F);
    sample.scale *= t * t * (3.0F - 2.0F * t);
    sample.pdf = sample.pdf > 0.0F && sample.scale > 0.0F ? 1.0F : 0.0F;
    return sample;
  }
  double powerExtent(std::uint32_t /*element*/) const {
    return 2.0 * static_cast<double>(kPi) * (1.0 - static_cast<double>(cosCone));
  }
  LightBounds bounds(std::uint32_t element) const {
    LightBounds bounds = lamp.bounds(element);
    bounds.axis = direction;
    bounds.spread = std::acos(cosCone);
    return bounds;
  }
};

}  // namespace metamer::spectral_ref
