// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "geometry/embree_scene.h"
#include "geometry/geometry.h"
#include "lights/light_tree.h"
#include "metamer/spectral_ref/scene.h"

namespace metamer::spectral_ref {

/// A point on a light, seen from a point that it lights.
struct LightSample {
  Vec3 direction = Vec3::Zero();  ///< unit, towards the light
  float distance = 0;             ///< infinite for the environment
  float pdf = 0;         ///< of the direction, per steradian, choice of the light included; of the choice for a delta
  bool isDelta = false;  ///< point and spot lights: no ray hits them
  std::uint32_t emitter = 0;  ///< whose radiance() it is ...
  std::uint32_t element = 0;
  float scale = 1;  ///< ... times this (point and spot lights: fall-off with distance and angle)
};

/// What an emitter shines: a spectrum, or the pixels of a picture, one an element.
struct Glow {
  SpectrumId spectrum = 0;
  const EmitterPicture* picture = nullptr;
};

/// A point of an element that has an area.
struct AreaPoint {
  Vec3 place;
  Vec3 area;  ///< normal, as long as the element's area
};

/// From a density over area to one over solid angle.
inline LightSample seenOnArea(const AreaPoint& point, const Vec3& from) {
  LightSample sample;
  const Vec3 towards = point.place - from;
  const float squared = towards.squaredNorm();
  sample.distance = std::sqrt(squared);
  sample.direction = towards / sample.distance;
  const float seen = -sample.direction.dot(point.area);
  sample.pdf = seen > 0.0F ? squared / seen : 0.0F;
  return sample;
}

/// The density over solid angle with which seenOnArea() finds what a ray hit.
inline float densityOnArea(const Hit& hit, float area, const Vec3& from, const Vec3& direction) {
  const float cosine = -direction.dot(hit.normal);
  return cosine > 0.0F ? (hit.position - from).squaredNorm() / (cosine * area) : 0.0F;
}

/// The receiver's cosine over the density.
inline float geometryOfArea(const AreaPoint& point, const Vec3& from, const Vec3& normal) {
  const Vec3 towards = point.place - from;
  const float squared = towards.squaredNorm();
  return std::max(0.0F, towards.dot(normal)) * std::max(0.0F, -towards.dot(point.area)) / (squared * squared);
}

/// Of emitters that no ray hits.
struct NeverHit {
  static std::uint32_t elementOf(const Hit&) { return 0; }
  static float pdf(const Hit&, const Vec3& /*from*/, const Vec3& /*direction*/) { return 0.0F; }
};

}  // namespace metamer::spectral_ref
