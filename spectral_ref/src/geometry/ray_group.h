// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "geometry/geometry.h"

/// Before a loop over the rays of a group, whose arrays lie apart: compilers fill vector lanes only where they know,
/// and do not ask of more than a few arrays.
#if defined(__clang__)
#define METAMER_RAYS_APART _Pragma("clang loop vectorize(assume_safety)")
#elif defined(__GNUC__)
#define METAMER_RAYS_APART _Pragma("GCC ivdep")
#else
#define METAMER_RAYS_APART
#endif

namespace metamer::spectral_ref {

/// No emitter, no picture, no hit.
inline constexpr std::uint32_t kNone = 0xffffffffU;

/// What lies where a ray ends.
struct Hit {
  Vec3 position;
  Vec3 normal;  ///< unit, the side that reflects and emits
  float distance = 0;
  float u = 0;  ///< along a rectangle, 0 ... 1
  float v = 0;
  std::uint32_t material = 0;
  std::uint32_t emitter = kNone;  ///< shape's number among emitting shapes (EmitterShape)
  std::uint32_t primitive = 0;    ///< triangle within a mesh
};

/// Rays that are traced at once.
inline constexpr std::size_t kRaysTogether = 16;
/// Bit i stands for ray i of a group.
using RayMask = std::uint32_t;

/// The first so many rays of a group.
constexpr RayMask firstRays(std::size_t count) {
  return (RayMask{1} << count) - 1U;
}
inline constexpr RayMask kAllRays = firstRays(kRaysTogether);

/// Calls `work` with the number of each ray of a mask, from the first.
template <typename Work>
void forEachRay(RayMask mask, const Work& work) {
  for (; mask != 0; mask &= mask - 1U) {
    work(static_cast<std::size_t>(std::countr_zero(mask)));
  }
}

/// A number for each ray of a group, side by side as vector lanes have them.
template <typename T>
using EachRay = std::array<T, kRaysTogether>;

/// The bit of each ray: a table, for masks that vector lanes make.
inline constexpr EachRay<RayMask> kRayBits = [] {
  EachRay<RayMask> bits{};
  for (std::size_t i = 0; i < kRaysTogether; ++i) {
    bits[i] = RayMask{1} << i;
  }
  return bits;
}();

/// A vector for each ray.
struct alignas(64) EachVec3 {
  EachRay<float> x{};
  EachRay<float> y{};
  EachRay<float> z{};

  Vec3 operator[](std::size_t i) const { return {x[i], y[i], z[i]}; }
  void set(std::size_t i, const Vec3& vector) {
    x[i] = vector.x();
    y[i] = vector.y();
    z[i] = vector.z();
  }
};

struct RayGroup {
  EachVec3 origin;
  EachVec3 direction;
  EachRay<float> most{};  ///< as Ray's, in lengths of the direction

  Ray operator[](std::size_t i) const { return {origin[i], direction[i], most[i]}; }
  void set(std::size_t i, const Ray& ray) {
    origin.set(i, ray.origin);
    direction.set(i, ray.direction);
    most[i] = ray.most;
  }
};

struct HitGroup {
  EachVec3 position;
  EachVec3 normal;
  EachRay<float> distance{};
  EachRay<float> u{};
  EachRay<float> v{};
  EachRay<std::uint32_t> material{};
  EachRay<std::uint32_t> emitter{};
  EachRay<std::uint32_t> primitive{};

  Hit operator[](std::size_t i) const {
    return {position[i], normal[i], distance[i], u[i], v[i], material[i], emitter[i], primitive[i]};
  }
  void set(std::size_t i, const Hit& hit) {
    position.set(i, hit.position);
    normal.set(i, hit.normal);
    distance[i] = hit.distance;
    u[i] = hit.u;
    v[i] = hit.v;
    material[i] = hit.material;
    emitter[i] = hit.emitter;
    primitive[i] = hit.primitive;
  }
};

}  // namespace metamer::spectral_ref
