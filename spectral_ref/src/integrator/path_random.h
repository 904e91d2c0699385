// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "geometry/geometry.h"
#include "integrator/sampler.h"
#include "lights/light_table.h"

namespace metamer::spectral_ref {

/// Random numbers of a path by use. Set 0 serves the camera and the first vertex; vertex n > 0 has set n.
class PathRandom {
 public:
  /// Begins a path. @return  where the sampler's set 0 is to be put
  Sampler::Set& begin(const Sampler& sampler) {
    m_sampler = sampler;
    return m_set;
  }

  Eigen::Vector2f pixel() const { return {m_set[0], m_set[1]}; }
  float wavelength() const { return m_set[2]; }

  /// Several paths go on to a vertex: before any of the below.
  static void vertex(std::uint32_t number, std::span<PathRandom* const> paths) {
    std::array<const Sampler*, Sampler::kMostTogether> samplers{};
    std::array<Sampler::Set*, Sampler::kMostTogether> sets{};
    for (std::size_t i = 0; i < paths.size(); ++i) {
      paths[i]->m_vertex = number;
      paths[i]->m_offset = number > 0 ? 0 : 3;
      samplers[i] = &paths[i]->m_sampler;
      sets[i] = &paths[i]->m_set;
    }
    if (number > 0) {
      Sampler::fill({samplers.data(), paths.size()}, number, {sets.data(), paths.size()});
    }
  }
  std::uint32_t light() const { return m_set.bits[m_offset + 2]; }
  Eigen::Vector2f onLight() const { return {m_set[m_offset], m_set[m_offset + 1]}; }
  Eigen::Vector2f direction() const { return {m_set[m_offset + 3], m_set[m_offset + 4]}; }
  /// Chooses among the candidates of resampling, in place of light().
  float candidate() const { return m_set[m_offset + 2]; }
  Sampler::Candidates candidates(unsigned log2Count) const { return m_sampler.candidates(kCandidateSet, log2Count); }
  float lobe() const { return m_vertex > 0 ? m_set[5] : m_sampler.random(0); }
  /// What a fluorescent surface does: keep the lanes or shift them, and where to. Numbers of their own, so that no
  /// other surface's change.
  Eigen::Vector2f fluorescence() const {
    const Sampler::Set set = m_sampler.set(kFluorescenceSets + m_vertex);
    return {set[0], set[1]};
  }
  float roulette() const { return m_vertex > 0 ? m_set[6] : m_sampler.random(1); }

 private:
  static constexpr std::uint32_t kCandidateSet = 0x63616e64U;      ///< no vertex has this number
  static constexpr std::uint32_t kFluorescenceSets = 0x666c0000U;  ///< and from here on

  Sampler m_sampler;
  Sampler::Set m_set{};
  std::size_t m_offset = 3;
  std::uint32_t m_vertex = 0;
};

}  // namespace metamer::spectral_ref
