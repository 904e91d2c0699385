// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <limits>

#include "metamer/spectral/vector_lanes.h"

namespace metamer::spectral_ref {

using Vec3 = Eigen::Vector3f;

inline constexpr float kPi = 3.14159265358979323846F;
inline constexpr double kRadiansADegree = 3.14159265358979323846 / 180.0;
inline constexpr float kInversePi = 1.0F / kPi;

/// Orthonormal axes about a unit normal (Duff et al. 2017, Building an Orthonormal Basis, Revisited).
struct Frame {
  Vec3 s;
  Vec3 t;
  Vec3 n;

  explicit Frame(const Vec3& normal) : n(normal) {
    const float sign = std::copysign(1.0F, n.z());
    const float a = -1.0F / (sign + n.z());
    const float b = n.x() * n.y() * a;
    s = Vec3(1.0F + sign * n.x() * n.x() * a, sign * b, -sign * n.x());
    t = Vec3(b, sign + n.y() * n.y() * a, -n.y());
  }
  Vec3 toLocal(const Vec3& v) const { return {v.dot(s), v.dot(t), v.dot(n)}; }
  Vec3 toWorld(const Vec3& v) const { return s * v.x() + t * v.y() + n * v.z(); }
};

/// A point of the unit disc from the unit square, areas kept in proportion (Shirley and Chiu 1997). In steps that all
/// take: the angle from the nearer axis is at most an eighth of a turn, and there few terms of the series do.
METAMER_ALWAYS_INLINE void squareToDisc(float u, float v, float& x, float& y) {
  const float a = 2.0F * u - 1.0F;
  const float b = 2.0F * v - 1.0F;
  const bool isWide = std::abs(a) > std::abs(b);
  const float radius = isWide ? a : b;
  const float other = isWide ? b : a;
  const float angle = 0.25F * kPi * (other / (radius == 0.0F ? 1.0F : radius));
  const float s = angle * angle;
  const float cosine = 1.0F + s * (-0.5F + s * (1.0F / 24.0F + s * (-1.0F / 720.0F + s * (1.0F / 40320.0F))));
  const float sine =
      angle * (1.0F + s * (-1.0F / 6.0F + s * (1.0F / 120.0F + s * (-1.0F / 5040.0F + s * (1.0F / 362880.0F)))));
  const float along = radius * cosine;
  const float across = radius * sine;
  x = isWide ? along : across;
  y = isWide ? across : along;
}
inline Eigen::Vector2f squareToDisc(float u, float v) {
  Eigen::Vector2f point;
  squareToDisc(u, v, point.x(), point.y());
  return point;
}

/// A direction about +z with density cos / pi.
inline Vec3 squareToCosineHemisphere(float u, float v) {
  const Eigen::Vector2f p = squareToDisc(u, v);
  return {p.x(), p.y(), std::sqrt(std::max(0.0F, 1.0F - p.squaredNorm()))};
}

/// A direction within a cone about +z, uniform in solid angle. `oneMinusCos` of the half angle keeps small cones exact.
inline Vec3 squareToCone(float u, float v, float oneMinusCos) {
  const float drop = u * oneMinusCos;
  const float sine = std::sqrt(std::max(0.0F, drop * (2.0F - drop)));
  const float phi = 2.0F * kPi * v;
  return {sine * std::cos(phi), sine * std::sin(phi), 1.0F - drop};
}

struct Ray {
  Vec3 origin;
  Vec3 direction;  ///< unit
  float most = std::numeric_limits<float>::infinity();
};

/// As std::max, by value: vector lanes are filled by it.
METAMER_ALWAYS_INLINE float larger(float a, float b) {
  return a > b ? a : b;
}

/// How far off a surface rays begin: float positions carry an error in proportion to their size.
METAMER_ALWAYS_INLINE float offDistance(float x, float y, float z) {
  constexpr float kRelative = 1e-5F;
  return kRelative * (1.0F + larger(larger(std::abs(x), std::abs(y)), std::abs(z)));
}

/// A point a little off a surface, on the side that `direction` leaves to.
inline Vec3 offPoint(const Vec3& point, const Vec3& normal, const Vec3& direction) {
  const float distance = offDistance(point.x(), point.y(), point.z());
  return point + normal * std::copysign(distance, normal.dot(direction));
}

}  // namespace metamer::spectral_ref
