// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "materials/bsdf.h"
#include "materials/ggx.h"
#include "wavelengths/lanes.h"

namespace metamer::spectral_ref {

/// Fresnel reflectance of clear matter, unpolarised. @param cosine  on the side the light comes from, positive
/// @param eta  index of the other side over this one
template <int C>
Lanes<C> dielectricFresnel(float cosine, const Lanes<C>& eta) {
  const Lanes<C> sin2 = (1.0F - cosine * cosine) / eta.square();
  const Lanes<C> other = (1.0F - sin2).max(0.0F).sqrt();
  const Lanes<C> parallel = (eta * cosine - other) / (eta * cosine + other);
  const Lanes<C> across = (cosine - eta * other) / (cosine + eta * other);
  return (sin2 < 1.0F).select(0.5F * (parallel.square() + across.square()), 1.0F);
}

/// Refracts about a normal on the side of `out`. @return false at total reflection
inline bool refract(const Vec3& out, const Vec3& normal, float eta, Vec3& in) {
  const float cosine = out.dot(normal);
  const float sin2 = std::max(0.0F, 1.0F - cosine * cosine) / (eta * eta);
  if (sin2 >= 1.0F) {
    return false;
  }
  in = -out / eta + (cosine / eta - std::sqrt(1.0F - sin2)) * normal;
  return true;
}

/// A clear surface, smooth or rough (Walter et al. 2007), between vacuum, where its normal points, and matter.
///
/// Whether light is reflected is decided by the mean over the lanes, the same for every hero. Where it is refracted,
/// the hero's index alone gives the direction: a smooth surface then carries no other lane where indices differ, and a
/// rough one those whose facets could have done the same.
template <int C, bool kDispersive>
struct DielectricBsdf {
  Lanes<C> index = Lanes<C>::Ones();
  bool isDispersive = false;
  bool isRough = false;
  Ggx ggx{1.0F};

  BsdfValue<C, kDispersive> evaluate(const Vec3& outGiven, const Vec3& inGiven) const {
    BsdfValue<C, kDispersive> result;
    if (!isRough || outGiven.z() == 0.0F || inGiven.z() == 0.0F) {
      return result;
    }
    // Seen from the side of `out`.
    const float side = outGiven.z() > 0.0F ? 1.0F : -1.0F;
    const Vec3 out = outGiven * side;
    const Vec3 in = inGiven * side;
    const Lanes<C> eta = side > 0.0F ? index : Lanes<C>(1.0F / index);
    if (in.z() > 0.0F) {
      const Vec3 h = (out + in).normalized();
      const Lanes<C> fresnel = dielectricFresnel<C>(std::clamp(out.dot(h), 0.0F, 1.0F), eta);
      result.value = fresnel * (ggx.density(h) * ggx.maskingShadowing(out, in) / (4.0F * out.z()));
      result.pdf = sameForAll<C, kDispersive>(fresnel.mean() * ggx.masking(out) * ggx.density(h) / (4.0F * out.z()));
      return result;
    }
    if constexpr (kDispersive) {
      result.pdf = Lanes<C>::Zero();
      for (int k = 0; k < C; ++k) {
        result.pdf[k] = transmitted(out, in, eta, k, result.value[k]);
      }
    } else {
      float value = 0;
      result.pdf = transmitted(out, in, eta, 0, value);
      result.value.setConstant(value);
    }
    return result;
  }

  BsdfSample<C, kDispersive> sample(const Vec3& outGiven, float u, float v, float lobe) const {
    BsdfSample<C, kDispersive> result;
    if (outGiven.z() == 0.0F) {
      return result;
    }
    const float side = outGiven.z() > 0.0F ? 1.0F : -1.0F;
    const Vec3 out = outGiven * side;
    const Lanes<C> eta = side > 0.0F ? index : Lanes<C>(1.0F / index);
    const Vec3 h = isRough ? ggx.sampleVisible(out, u, v) : Vec3(0.0F, 0.0F, 1.0F);
    const float cosine = out.dot(h);
    if (!(cosine > 0.0F)) {
      return result;
    }
    const Lanes<C> fresnel = dielectricFresnel<C>(std::min(cosine, 1.0F), eta);
    const float reflected = fresnel.mean();
    const bool reflects = lobe < reflected;
    if (reflects) {
      result.direction = 2.0F * cosine * h - out;
    } else if (!refract(out, h, eta[0], result.direction)) {
      return result;
    }
    if ((result.direction.z() > 0.0F) != reflects) {
      return result;  // a facet that would send it through the surface: lost, as in any single-bounce model
    }
    result.direction *= side;
    if (isRough) {
      const auto value = evaluate(outGiven, result.direction);
      if (heroDensity(value.pdf) > 0.0F) {
        result.weight = value.value / heroDensity(value.pdf);
        result.pdf = value.pdf;
      }
      return result;
    }
    result.isDelta = true;
    if (reflects) {
      result.weight = fresnel / reflected;
      result.pdf = sameForAll<C, kDispersive>(reflected);
      return result;
    }
    const float passed = 1.0F - reflected;
    result.weight = (1.0F - fresnel) / (passed * eta.square());
    result.pdf = sameForAll<C, kDispersive>(passed);
    if constexpr (kDispersive) {
      if (isDispersive) {
        for (int k = 1; k < C; ++k) {
          result.weight[k] = 0.0F;
          result.pdf[k] = 0.0F;
        }
      }
    }
    return result;
  }

 private:
  /// BTDF times |cos| (for radiance) of one lane; returns the density with that lane as hero.
  float transmitted(const Vec3& out, const Vec3& in, const Lanes<C>& eta, int k, float& value) const {
    const Vec3 bent = out + eta[k] * in;
    const float length = bent.norm();
    if (!(length > 0.0F)) {
      return 0.0F;
    }
    // The facet normal lies on the side of `out`.
    const Vec3 h = bent * ((bent.z() > 0.0F ? 1.0F : -1.0F) / length);
    const float outCosine = out.dot(h);
    const float inCosine = in.dot(h);
    if (!(outCosine > 0.0F) || !(inCosine < 0.0F)) {
      return 0.0F;
    }
    const Lanes<C> passed = 1.0F - dielectricFresnel<C>(std::min(outCosine, 1.0F), eta);
    const float root = inCosine + outCosine / eta[k];
    const float jacobian = -inCosine / (root * root);
    const float d = ggx.density(h);
    value = passed[k] * d * ggx.maskingShadowing(out, in) * outCosine * jacobian / (out.z() * eta[k] * eta[k]);
    return passed.mean() * ggx.masking(out) * outCosine * d / out.z() * jacobian;
  }
};

}  // namespace metamer::spectral_ref
