// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "materials/bsdf.h"

namespace metamer::spectral_ref {

/// Lambert's reflector on the front, black on the back.
template <int C, bool kDispersive>
struct DiffuseBsdf {
  Lanes<C> reflectance = Lanes<C>::Zero();

  BsdfValue<C, kDispersive> evaluate(const Vec3& out, const Vec3& in) const {
    BsdfValue<C, kDispersive> result;
    if (out.z() > 0.0F && in.z() > 0.0F) {
      const float cosine = in.z() * kInversePi;
      result.value = reflectance * cosine;
      result.pdf = sameForAll<C, kDispersive>(cosine);
    }
    return result;
  }
  BsdfSample<C, kDispersive> sample(const Vec3& out, float u, float v) const {
    BsdfSample<C, kDispersive> result;
    if (out.z() > 0.0F) {
      result.direction = squareToCosineHemisphere(u, v);
      result.weight = reflectance;
      result.pdf = sameForAll<C, kDispersive>(result.direction.z() * kInversePi);
    }
    return result;
  }
};

}  // namespace metamer::spectral_ref
