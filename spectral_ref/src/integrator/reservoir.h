// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "geometry/geometry.h"
#include "integrator/sampler.h"
#include "lights/light_cuts.h"
#include "lights/light_table.h"
#include "wavelengths/lanes.h"

namespace metamer::spectral_ref {

/// What decides the target function of a pixel's reservoir: the receiver and its wavelengths (z_i and lambda_i
/// of 4.3.2).
template <int C>
struct ReservoirDomain {
  std::array<float, 3> place{};
  std::array<float, 3> up{};
  std::array<float, C> factor{};  ///< of each lane's radiance in the target
  std::array<std::int16_t, C> cell{};
  std::uint32_t block = 0;  ///< whose light cut it draws candidates from

  Vec3 position() const { return {place[0], place[1], place[2]}; }
  Vec3 normal() const { return {up[0], up[1], up[2]}; }
};

/// One light point, chosen from many candidates. Plain bytes: a checkpoint keeps them.
template <int C>
struct Reservoir {
  LightPoint point;
  float contribution = 0;  ///< unbiased contribution weight W of the point, per light and unit of (u, v); 0: no point
  float target = 0;        ///< of the point at the domain
  float confidence = 0;    ///< candidates it stands for; 0: never filled
  ReservoirDomain<C> domain;
};

/// Target functions and merging of reservoirs (4.14 to 4.20).
///
/// Points are compared by light and (u, v) on it: the shift between two receivers keeps the point, so its Jacobian
/// is 1. Visibility is in no target: each estimate tests it for its own point, so none is lost or gained by an occluder
/// that another receiver sees.
template <int C>
class ReservoirSampler {
 public:
  /// Few: from the light cut they follow the target closely, and each costs about half as much as a shadow ray.
  static constexpr unsigned kLog2Candidates = 1;
  static constexpr std::size_t kCandidates = std::size_t{1} << kLog2Candidates;

  static constexpr auto kShare = static_cast<float>(kCandidates);

  ReservoirSampler(const LightTable& lights, const SpectrumTables& spectra, const LightCuts& cuts)
      : m_lights(lights), m_spectra(spectra), m_cuts(cuts) {}

  /// A point as a domain sees it.
  struct Seen {
    LightSample light;
    float geometry = 0;  ///< what radiance and reflectance are multiplied with, per light and unit of (u, v)
  };
  Seen look(const LightPoint& point, const ReservoirDomain<C>& domain) const {
    Seen seen;
    seen.light = m_lights.located(point, domain.position());
    const float cosine = seen.light.direction.dot(domain.normal());
    if (!(seen.light.pdf > 0.0F) || !(cosine > 0.0F)) {
      return seen;
    }
    seen.geometry = cosine * kInversePi * seen.light.scale / seen.light.pdf;
    if (m_cuts.isNear(domain.block) && !seen.light.isDelta) {
      seen.geometry *= lightWeight(seen.light.pdf * m_cuts.probability(domain.block, point.entry), cosine * kInversePi);
    }
    return seen;
  }

  /// Next-event estimation against BSDF sampling, by the balance heuristic with the candidates' density: a rule of
  /// the point and the receiver alone, so that both techniques weigh a point alike, however it was resampled. Blocks
  /// without a light nearby leave all to next-event estimation.
  static float lightWeight(float candidatePdf, float bsdfPdf) {
    return kShare * candidatePdf / (kShare * candidatePdf + bsdfPdf);
  }
  /// The other technique's weight for light that a BSDF sample has found from a domain's receiver.
  float bsdfWeight(const ReservoirDomain<C>& domain, std::uint32_t entry, float locatedPdf, float bsdfPdf) const {
    return m_cuts.isNear(domain.block)
               ? 1.0F - lightWeight(m_cuts.probability(domain.block, entry) * locatedPdf, bsdfPdf)
               : 0.0F;
  }
  bool needsBsdf(const ReservoirDomain<C>& domain) const { return m_cuts.isNear(domain.block); }

  /// p-hat: (4.15) with the BSDF in, over the lanes that `factor` chooses.
  float target(const LightPoint& point, const ReservoirDomain<C>& domain) const {
    const float geometry = m_cuts.isNear(domain.block)
                               ? look(point, domain).geometry
                               : m_lights.geometry(point, domain.position(), domain.normal()) * kInversePi;
    if (!(geometry > 0.0F)) {
      return 0.0F;
    }
    return geometry * m_lights.template response<C>(point.entry, m_spectra, domain.cell, domain.factor);
  }

  /// A fresh sample from candidates of the block's light cut (4.14, 4.17).
  /// @param u  chooses among them
  Reservoir<C> fresh(const ReservoirDomain<C>& domain, const Sampler::Candidates& candidates, float u) const {
    Reservoir<C> reservoir;
    reservoir.domain = domain;
    reservoir.confidence = kShare;
    std::array<LightPoint, kCandidates> points;
    std::array<float, kCandidates> targets;
    std::array<float, kCandidates> below;
    float sum = 0;
    for (std::size_t i = 0; i < kCandidates; ++i) {
      const auto bits = candidates.point(static_cast<std::uint32_t>(i));
      const LightCuts::Choice choice = m_cuts.choose(domain.block, bits[0]);
      points[i] = {choice.light, unitFloat(bits[1]), unitFloat(bits[2])};
      targets[i] = target(points[i], domain);
      sum += targets[i] / choice.probability;
      below[i] = sum;
    }
    if (!(sum > 0.0F)) {
      return reservoir;
    }
    std::size_t chosen = 0;
    while (chosen + 1 < kCandidates && !(u * sum < below[chosen])) {
      ++chosen;
    }
    if (targets[chosen] > 0.0F) {
      reservoir.point = points[chosen];
      reservoir.target = targets[chosen];
      reservoir.contribution = sum / (targets[chosen] * kShare);
    }
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
    if (own.contribution > 0.0F) {
      const float there = target(own.point, other.domain);
      const float m = ownConfidence * own.target / (ownConfidence * own.target + otherConfidence * there);
      ownWeight = m * own.target * own.contribution;
    }
    float otherWeight = 0;
    float otherTarget = 0;
    if (other.contribution > 0.0F) {
      otherTarget = target(other.point, own.domain);
      if (otherTarget > 0.0F) {
        const float m = otherConfidence * other.target / (ownConfidence * otherTarget + otherConfidence * other.target);
        otherWeight = m * otherTarget * other.contribution;
      }
    }
    const float sum = ownWeight + otherWeight;
    own.confidence += otherConfidence;
    if (!(sum > 0.0F)) {
      own.contribution = 0.0F;
      own.target = 0.0F;
      return;
    }
    if (u * sum < otherWeight) {
      own.point = other.point;
      own.target = otherTarget;
    }
    own.contribution = own.target > 0.0F ? sum / own.target : 0.0F;
  }

 private:
  const LightTable& m_lights;
  const SpectrumTables& m_spectra;
  const LightCuts& m_cuts;
};

}  // namespace metamer::spectral_ref
