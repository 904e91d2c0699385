// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "geometry/geometry.h"

namespace metamer::spectral_ref {

/// Microfacets of Trowbridge and Reitz (GGX) of one roughness alpha, directions in the frame of the surface.
struct Ggx {
  float alpha;

  /// Density of normals.
  float density(const Vec3& h) const {
    const float a2 = alpha * alpha;
    // sin^2 + a^2 cos^2: nothing cancels near the pole of a smooth surface.
    const float d = h.x() * h.x() + h.y() * h.y() + a2 * h.z() * h.z();
    return a2 / (kPi * d * d);
  }
  /// Smith's masking function.
  float lambda(const Vec3& v) const {
    const float z2 = v.z() * v.z();
    const float tan2 = std::max(0.0F, 1.0F - z2) / std::max(z2, 1e-12F);
    return 0.5F * (std::sqrt(1.0F + alpha * alpha * tan2) - 1.0F);
  }
  float masking(const Vec3& v) const { return 1.0F / (1.0F + lambda(v)); }
  /// Height-correlated masking and shadowing; both directions may lie on either side.
  float maskingShadowing(const Vec3& a, const Vec3& b) const { return 1.0F / (1.0F + lambda(a) + lambda(b)); }

  /// Density of normals that `v` sees (v.z > 0).
  float visibleDensity(const Vec3& v, const Vec3& h) const {
    return masking(v) * std::max(0.0F, v.dot(h)) * density(h) / std::max(v.z(), 1e-9F);
  }
  /// Draws one of them (Dupuy and Benyoub 2023, spherical caps).
  Vec3 sampleVisible(const Vec3& v, float u1, float u2) const {
    const Vec3 stretched = Vec3(alpha * v.x(), alpha * v.y(), v.z()).normalized();
    const float phi = 2.0F * kPi * u1;
    const float z = (1.0F - u2) * (1.0F + stretched.z()) - stretched.z();
    const float sine = std::sqrt(std::clamp(1.0F - z * z, 0.0F, 1.0F));
    const Vec3 h = Vec3(sine * std::cos(phi), sine * std::sin(phi), z) + stretched;
    return Vec3(alpha * h.x(), alpha * h.y(), std::max(1e-12F, h.z())).normalized();
  }
};

}  // namespace metamer::spectral_ref
