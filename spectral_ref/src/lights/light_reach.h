// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <limits>
#include <vector>

#include "lights/light_table.h"
#include "lights/light_tree.h"

namespace metamer::spectral_ref {

/// Where lights are so near that points on one of them differ much in what they give: there a direction drawn by a
/// surface adds to next-event estimation, elsewhere hardly. A rule of the place alone.
class LightReach {
 public:
  LightReach(const LightTable& lights, const Scene& scene) : m_isEverywhere(lights.hasEnvironment()) {
    if (m_isEverywhere) {
      return;
    }
    float widest = 0;
    for (const LightBounds& light : lights.bounds(scene)) {
      m_least = m_least.cwiseMin(light.least);
      m_most = m_most.cwiseMax(light.most);
      widest = std::max(widest, 0.5F * (light.most - light.least).norm());
    }
    m_reach = widest / kNear;
  }

  /// Of the places of several hits, those that are.
  RayMask areNear(const HitGroup& hits) const;

  /// Whether any light may take up much of the view from there.
  bool isNear(const Vec3& place) const {
    const Vec3 beyond = (m_least - place).cwiseMax(place - m_most).cwiseMax(0.0F);
    return m_isEverywhere || beyond.squaredNorm() <= m_reach * m_reach;
  }

 private:
  /// Of a light's half size to its distance.
  static constexpr float kNear = 0.5F;

  bool m_isEverywhere;
  Vec3 m_least = Vec3::Constant(std::numeric_limits<float>::infinity());  ///< box around all lights
  Vec3 m_most = Vec3::Constant(-std::numeric_limits<float>::infinity());
  float m_reach = 0;
};

}  // namespace metamer::spectral_ref
