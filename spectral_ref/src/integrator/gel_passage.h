// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>

#include "geometry/geometry.h"
#include "integrator/prepared_scene.h"
#include "wavelengths/lanes.h"

// Rays on their way through gels, which colour what passes and count as no edge of a path.
namespace metamer::spectral_ref {

enum class Passage { Hit, Escaped, Absorbed };

/// Of the gel that a ray has hit.
template <int C>
Lanes<C> transmittanceAt(const PreparedScene& prepared, const Ray& ray, const Hit& hit,
                         const WavelengthSet<C>& wavelengths) {
  return prepared.materials.gelTransmittance<C>(hit.material, std::abs(ray.direction.dot(hit.normal)), prepared.spectra,
                                                wavelengths);
}

/// Follows a ray to the next surface that scatters.
/// @param ray         starts at the last gel afterwards
/// @param throughput  loses what gels keep
template <int C>
Passage throughGels(const PreparedScene& prepared, Ray& ray, Hit& hit, Lanes<C>& throughput,
                    const WavelengthSet<C>& wavelengths) {
  while (prepared.shapes.intersect(ray, hit)) {
    if (!prepared.materials.isGel(hit.material)) {
      return Passage::Hit;
    }
    throughput *= transmittanceAt(prepared, ray, hit, wavelengths);
    if (!(throughput.maxCoeff() > 0.0F)) {
      return Passage::Absorbed;
    }
    ray.origin = offPoint(hit.position, hit.normal, ray.direction);
  }
  return Passage::Escaped;
}

/// What gels leave of the light between two points; false where something else lies between, or nothing is left.
/// @param ray      from one to the other, as of shadowRay()
/// @param emitter  that the light comes from
template <int C>
bool gelsTransmit(const PreparedScene& prepared, Ray ray, std::uint32_t emitter, Lanes<C>& light,
                  const WavelengthSet<C>& wavelengths) {
  if (!prepared.materials.hasGels()) {
    return !prepared.shapes.occluded(ray);
  }
  Hit hit;
  while (prepared.shapes.intersect(ray, hit)) {
    if (hit.emitter == emitter) {
      return true;  // the light itself, found a little early
    }
    if (!prepared.materials.isGel(hit.material)) {
      return false;
    }
    light *= transmittanceAt(prepared, ray, hit, wavelengths);
    if (!(light.maxCoeff() > 0.0F)) {
      return false;
    }
    const Vec3 next = offPoint(hit.position, hit.normal, ray.direction);
    ray.most -= (next - ray.origin).dot(ray.direction);
    ray.origin = next;
  }
  return true;
}

/// Of a ray to a light, of the way: short of it by more than float error.
inline constexpr float kShortOfLight = 1.0F - 1e-4F;

/// The ray from a surface to a point on a light.
inline Ray shadowRay(const Hit& hit, const LightSample& light) {
  Ray ray;
  ray.origin = offPoint(hit.position, hit.normal, light.direction);
  ray.direction = light.direction;
  ray.most = light.distance;
  if (std::isfinite(light.distance)) {
    // From where it starts: a light close by must not hide itself.
    const Vec3 towards = hit.position + light.direction * light.distance - ray.origin;
    ray.most = towards.norm();
    ray.direction = towards / ray.most;
    ray.most *= kShortOfLight;
  }
  return ray;
}

}  // namespace metamer::spectral_ref
