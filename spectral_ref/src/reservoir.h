// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "geometry.h"
#include "lanes.h"
#include "light_table.h"

namespace metamer::spectral_ref {

/// What decides the target function of a pixel's reservoir: the receiver and its wavelengths (z_i and lambda_i
/// of 4.3.2).
template <int C>
struct ReservoirDomain {
  std::array<float, 3> place{};
  std::array<float, 3> up{};
  std::array<float, C> factor{};  ///< of each lane's radiance in the target; zero lanes need no look-up
  std::array<std::uint16_t, C> cell{};

  Vec3 position() const { return {place[0], place[1], place[2]}; }
  Vec3 normal() const { return {up[0], up[1], up[2]}; }
  /// The cells alone.
  WavelengthSet<C> wavelengths() const {
    WavelengthSet<C> set;
    for (std::size_t k = 0; k < C; ++k) {
      set.cell[k] = cell[k];
    }
    return set;
  }
};

/// One light point, chosen from many candidates. Plain bytes: a checkpoint keeps them.
template <int C>
struct Reservoir {
  LightPoint point;
  float contribution = 0;  ///< unbiased contribution weight W of the point, over the measure of LightPoint; 0: no point
  float confidence = 0;    ///< candidates it stands for; 0: never filled
  ReservoirDomain<C> domain;
};

/// Target functions and merging of reservoirs (4.14 to 4.20), over the points that LightTable::choose draws.
///
/// Points are compared in the measure in which the table draws them uniformly by (u, v) from an entry: the shift
/// between two receivers keeps the point, so its Jacobian is 1. Visibility is in no target: each estimate tests it for
/// its own point, so none is lost or gained by an occluder that another receiver sees.
template <int C>
class ReservoirSampler {
 public:
  ReservoirSampler(const LightTable& lights, const SpectrumTables& spectra) : m_lights(lights), m_spectra(spectra) {}

  /// Share of next-event estimation in its sum with BSDF sampling: as if it had drawn this many candidates by power.
  /// Any number is unbiased, because both techniques weigh a point by the same rule.
  static constexpr float kLightShare = 16.0F;

  /// Light of a point at a domain: its radiance over (u, v) of its entry, cosines and distance in; per lane where the
  /// caller wants it.
  struct Seen {
    LightSample light;
    float geometry = 0;  ///< cosine / pi over the density: what radiance is multiplied with, MIS weight in
  };
  Seen look(const LightPoint& point, const ReservoirDomain<C>& domain) const {
    Seen seen;
    seen.light = m_lights.sample(point, domain.position());
    const float cosine = seen.light.direction.dot(domain.normal());
    if (!(seen.light.pdf > 0.0F) || !(cosine > 0.0F)) {
      return seen;
    }
    const float bsdfPdf = seen.light.isDelta ? 0.0F : cosine * kInversePi;
    const float lightPdf = seen.light.pdf;
    // The weight kLightShare p / (kLightShare p + p_bsdf), and 1 / p for the candidate's measure: `p` cancels in part.
    seen.geometry = cosine * kInversePi * seen.light.scale * kLightShare / (kLightShare * lightPdf + bsdfPdf);
    return seen;
  }

  /// p-hat over the measure in which candidates are uniform: (4.15) with the BSDF and the MIS weight in.
  float target(const LightPoint& point, const ReservoirDomain<C>& domain) const {
    const Seen seen = look(point, domain);
    return seen.geometry > 0.0F ? target(seen, domain) : 0.0F;
  }
  float target(const Seen& seen, const ReservoirDomain<C>& domain) const {
    const Lanes<C> radiance =
        m_lights.radiance(seen.light.emitter, seen.light.element, m_spectra, domain.wavelengths());
    const Eigen::Map<const Lanes<C>> factor(domain.factor.data());
    return seen.geometry * (radiance * factor).sum();
  }

  /// A fresh sample from `count` candidates (4.14, 4.17). Candidates are drawn by power: the measure's own density
  /// is 1.
  template <typename Draw>
  Reservoir<C> fresh(const ReservoirDomain<C>& domain, int count, const Draw& draw) const {
    Reservoir<C> reservoir;
    reservoir.domain = domain;
    reservoir.confidence = static_cast<float>(count);
    float sum = 0;
    float chosen = 0;
    for (int i = 0; i < count; ++i) {
      const auto [point, u] = draw(i);
      const float weight = target(point, domain);
      sum += weight;
      if (weight > 0.0F && u * sum < weight) {
        reservoir.point = point;
        chosen = weight;
      }
    }
    reservoir.contribution = chosen > 0.0F ? sum / (chosen * static_cast<float>(count)) : 0.0F;
    return reservoir;
  }

  /// Merges another reservoir into one, at the domain of the latter (4.16 to 4.20). The generalised Talbot weights
  /// count each by its confidence.
  void merge(Reservoir<C>& own, const Reservoir<C>& other, float otherConfidence, float u) const {
    if (!(otherConfidence > 0.0F)) {
      return;
    }
    const float ownConfidence = own.confidence;
    float ownWeight = 0;
    float ownTarget = 0;
    if (own.contribution > 0.0F) {
      ownTarget = target(own.point, own.domain);
      const float there = target(own.point, other.domain);
      const float m = ownConfidence * ownTarget / (ownConfidence * ownTarget + otherConfidence * there);
      ownWeight = m * ownTarget * own.contribution;
    }
    float otherWeight = 0;
    float otherTarget = 0;
    if (other.contribution > 0.0F) {
      otherTarget = target(other.point, own.domain);
      if (otherTarget > 0.0F) {
        const float there = target(other.point, other.domain);
        const float m = otherConfidence * there / (ownConfidence * otherTarget + otherConfidence * there);
        otherWeight = m * otherTarget * other.contribution;
      }
    }
    const float sum = ownWeight + otherWeight;
    own.confidence += otherConfidence;
    if (!(sum > 0.0F)) {
      own.contribution = 0.0F;
      return;
    }
    float chosen = ownTarget;
    if (u * sum < otherWeight) {
      own.point = other.point;
      chosen = otherTarget;
    }
    own.contribution = chosen > 0.0F ? sum / chosen : 0.0F;
  }

 private:
  const LightTable& m_lights;
  const SpectrumTables& m_spectra;
};

}  // namespace metamer::spectral_ref
