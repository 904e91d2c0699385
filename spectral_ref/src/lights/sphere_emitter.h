// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "lights/light_sample.h"

namespace metamer::spectral_ref {

/// A sphere that shines outwards, sampled evenly over the cone in which it is seen.
struct SphereEmitter {
  Vec3 centre;
  float radius = 0;

  template <typename Add>
  static void collect(const Scene& scene, const EmbreeScene& shapes, const Add& add) {
    for (std::size_t i = 0; i < scene.spheres.size(); ++i) {
      if (shapes.emitterOfSphere(i) != kNone) {
        const Sphere& sphere = scene.spheres[i];
        add(SphereEmitter{sphere.center.cast<float>(), static_cast<float>(sphere.radius)},
            Glow{sphere.surface.emission->spectrum, nullptr}, 1, shapes.emitterOfSphere(i));
      }
    }
  }

  LightSample located(std::uint32_t /*element*/, float u, float v, const Vec3& from) const {
    const Vec3 towards = centre - from;
    const float squared = towards.squaredNorm();
    const float radiusSquared = radius * radius;
    if (squared <= radiusSquared) {
      return {};  // inside: the sphere emits outwards
    }
    LightSample sample;
    const float sineSquared = radiusSquared / squared;
    const float oneMinusCos = sineSquared / (1.0F + std::sqrt(1.0F - sineSquared));
    const Vec3 local = squareToCone(u, v, oneMinusCos);
    sample.direction = Frame(towards / std::sqrt(squared)).toWorld(local);
    // Where the ray meets the sphere, less what float error makes of that for rays that graze it: nothing that blocks
    // the light hides in there.
    constexpr float kGrazing = 2e-3F;
    const float depth = oneMinusCos * (1.0F - u) * (2.0F - oneMinusCos * (1.0F + u));
    sample.distance = std::sqrt(squared) * (local.z() - std::sqrt(depth)) - kGrazing * radius;
    sample.pdf = 1.0F / (2.0F * kPi * oneMinusCos);
    return sample;
  }
  static std::uint32_t elementOf(const Hit&) { return 0; }
  float pdf(const Hit&, const Vec3& from, const Vec3& /*direction*/) const {
    const float squared = (centre - from).squaredNorm();
    const float radiusSquared = radius * radius;
    if (squared <= radiusSquared) {
      return 0.0F;
    }
    const float sineSquared = radiusSquared / squared;
    return (1.0F + std::sqrt(1.0F - sineSquared)) / (2.0F * kPi * sineSquared);
  }
  double powerExtent(std::uint32_t /*element*/) const {
    return static_cast<double>(kPi * (4.0F * kPi * radius * radius));
  }
  LightBounds bounds(std::uint32_t /*element*/) const {
    LightBounds bounds;
    bounds.least = centre - Vec3::Constant(radius);
    bounds.most = centre + Vec3::Constant(radius);
    bounds.spread = kPi;
    bounds.intensity = kPi * radius * radius;
    return bounds;
  }
};

}  // namespace metamer::spectral_ref
