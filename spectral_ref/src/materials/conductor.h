// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "materials/bsdf.h"
#include "materials/ggx.h"
#include "wavelengths/lanes.h"

namespace metamer::spectral_ref {

/// Light that one bounce among microfacets gives back where all is reflected, by the cosine it leaves with; and its
/// cosine-weighted mean. What is missing left in more bounces.
class GgxEnergy {
 public:
  GgxEnergy() = default;
  explicit GgxEnergy(float alpha);

  float at(float cosine) const {
    const float place = std::clamp(cosine, 0.0F, 1.0F) * (kNodes - 1);
    const auto i = std::min(static_cast<std::size_t>(place), std::size_t{kNodes - 2});
    const float t = place - static_cast<float>(i);
    return m_at[i] + t * (m_at[i + 1] - m_at[i]);
  }
  float mean() const { return m_mean; }

 private:
  static constexpr int kNodes = 64;
  std::array<float, kNodes> m_at{};
  float m_mean = 1;
};

/// Fresnel reflectance of a conductor against vacuum; eta and k its index.
template <int C>
Lanes<C> conductorFresnel(float cosine, const Lanes<C>& eta, const Lanes<C>& k) {
  const float cos2 = cosine * cosine;
  const float sin2 = 1.0F - cos2;
  const Lanes<C> eta2 = eta.square();
  const Lanes<C> k2 = k.square();
  const Lanes<C> t0 = eta2 - k2 - sin2;
  const Lanes<C> a2b2 = (t0.square() + 4.0F * eta2 * k2).sqrt();
  const Lanes<C> a = (0.5F * (a2b2 + t0)).max(0.0F).sqrt();
  const Lanes<C> t1 = a2b2 + cos2;
  const Lanes<C> t2 = 2.0F * cosine * a;
  const Lanes<C> rs = (t1 - t2) / (t1 + t2);
  const Lanes<C> t3 = cos2 * a2b2 + sin2 * sin2;
  const Lanes<C> t4 = t2 * sin2;
  return 0.5F * rs * (1.0F + (t3 - t4) / (t3 + t4));
}

/// Rough metal: GGX, with the bounces between facets added in the form of Kulla and Conty 2017, which keeps energy and
/// reciprocity. On the back it is black.
template <int C, bool kDispersive>
struct ConductorBsdf {
  Ggx ggx{1.0F};
  const GgxEnergy* energy = nullptr;
  bool isIndex = false;             ///< eta and k, else f0 by Schlick's approximation
  Lanes<C> eta = Lanes<C>::Ones();  ///< or f0
  Lanes<C> k = Lanes<C>::Zero();
  Lanes<C> mean = Lanes<C>::Ones();  ///< Fresnel reflectance averaged over cosine-weighted directions

  Lanes<C> fresnel(float cosine) const {
    if (isIndex) {
      return conductorFresnel<C>(cosine, eta, k);
    }
    const float c = 1.0F - cosine;
    const float c5 = c * c * c * c * c;
    return eta + (1.0F - eta) * c5;
  }

  BsdfValue<C, kDispersive> evaluate(const Vec3& out, const Vec3& in) const {
    BsdfValue<C, kDispersive> result;
    if (!(out.z() > 0.0F) || !(in.z() > 0.0F)) {
      return result;
    }
    const Vec3 h = (out + in).normalized();
    const float d = ggx.density(h);
    const float energyOut = energy->at(out.z());
    const Lanes<C> single =
        fresnel(std::min(1.0F, out.dot(h))) * (d * ggx.maskingShadowing(out, in) / (4.0F * out.z()));
    const float lost =
        (1.0F - energyOut) * (1.0F - energy->at(in.z())) / (kPi * std::max(1.0F - energy->mean(), 1e-6F));
    const Lanes<C> colour = mean.square() * energy->mean() / (1.0F - mean * (1.0F - energy->mean()));
    result.value = single + colour * (lost * in.z());
    const float pdf = energyOut * ggx.masking(out) * d / (4.0F * out.z()) + (1.0F - energyOut) * in.z() * kInversePi;
    result.pdf = sameForAll<C, kDispersive>(pdf);
    return result;
  }

  BsdfSample<C, kDispersive> sample(const Vec3& out, float u, float v, float lobe) const {
    BsdfSample<C, kDispersive> result;
    if (!(out.z() > 0.0F)) {
      return result;
    }
    if (lobe < energy->at(out.z())) {
      const Vec3 h = ggx.sampleVisible(out, u, v);
      result.direction = 2.0F * out.dot(h) * h - out;
    } else {
      result.direction = squareToCosineHemisphere(u, v);
    }
    const auto value = evaluate(out, result.direction);
    const float pdf = heroDensity(value.pdf);
    if (pdf > 0.0F) {
      result.weight = value.value / pdf;
      result.pdf = value.pdf;
    }
    return result;
  }
};

}  // namespace metamer::spectral_ref
