// SPDX-License-Identifier: Apache-2.0
#include "integrator/edge_map.h"

#include <array>

namespace metamer::spectral_ref {
namespace {

/// Where a pixel is looked at: all over the reach of its filter.
constexpr std::array<std::array<float, 2>, 8> kPlaces = {{{0.03F, 0.03F},
                                                          {0.97F, 0.03F},
                                                          {0.03F, 0.97F},
                                                          {0.97F, 0.97F},
                                                          {0.5F, 0.2F},
                                                          {0.2F, 0.6F},
                                                          {0.8F, 0.5F},
                                                          {0.5F, 0.8F}}};
/// Cosine between normals below which faces of one matter look different.
constexpr float kLikeNormal = 0.8F;

bool areAlike(const LightTable& lights, const Hit& a, const Hit& b) {
  return a.material == b.material && a.emitter == b.emitter && a.normal.dot(b.normal) > kLikeNormal &&
         (a.emitter == kNone || lights.elementOf(a) == lights.elementOf(b));
}

}  // namespace

EdgeMap::EdgeMap(const PreparedScene& prepared)
    : m_prepared(prepared),
      m_isEdge(static_cast<std::size_t>(prepared.scene.film.width) *
               static_cast<std::size_t>(prepared.scene.film.height)) {}

void EdgeMap::look(int x, int y) {
  EachRay<float> across{};
  EachRay<float> down{};
  for (std::size_t i = 0; i < kPlaces.size(); ++i) {
    const Eigen::Vector2f place = m_prepared.camera.filtered(x, y, {kPlaces[i][0], kPlaces[i][1]});
    across[i] = place.x();
    down[i] = place.y();
  }
  RayGroup rays;
  m_prepared.camera.rays(across, down, rays);
  HitGroup hits;
  const RayMask found = m_prepared.shapes.intersect(rays, firstRays(kPlaces.size()), hits, Course::Alike);
  bool isEdge = found != 0 && found != firstRays(kPlaces.size());
  const Hit first = hits[0];
  for (std::size_t i = 1; i < kPlaces.size() && found == firstRays(kPlaces.size()) && !isEdge; ++i) {
    isEdge = !areAlike(m_prepared.lights, first, hits[i]);
  }
  m_isEdge[static_cast<std::size_t>(y) * static_cast<std::size_t>(m_prepared.scene.film.width) +
           static_cast<std::size_t>(x)] = isEdge ? 1 : 0;
}

}  // namespace metamer::spectral_ref
