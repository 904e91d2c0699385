// SPDX-License-Identifier: Apache-2.0
#include "lights/light_reach.h"

#include "metamer/spectral/vector_lanes.h"

namespace metamer::spectral_ref {
namespace {

METAMER_ALWAYS_INLINE float beyond(float place, float least, float most) {
  return larger(larger(least - place, place - most), 0.0F);
}

METAMER_VECTOR_LANES RayMask within(const EachVec3& places, const Vec3& least, const Vec3& most, float squaredReach) {
  const float lx = least.x(), ly = least.y(), lz = least.z();
  const float mx = most.x(), my = most.y(), mz = most.z();
  RayMask result = 0;
  for (std::size_t i = 0; i < kRaysTogether; ++i) {
    const float x = beyond(places.x[i], lx, mx);
    const float y = beyond(places.y[i], ly, my);
    const float z = beyond(places.z[i], lz, mz);
    result |= x * x + y * y + z * z <= squaredReach ? kRayBits[i] : 0U;
  }
  return result;
}

}  // namespace

RayMask LightReach::areNear(const HitGroup& hits) const {
  return m_isEverywhere ? kAllRays : within(hits.position, m_least, m_most, m_reach * m_reach);
}

}  // namespace metamer::spectral_ref
