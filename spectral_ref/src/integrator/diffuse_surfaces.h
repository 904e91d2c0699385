// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "integrator/diffuse_group.h"
#include "integrator/gel_passage.h"
#include "integrator/path_state.h"
#include "integrator/prepared_scene.h"
#include "metamer/spectral/vector_lanes.h"

namespace metamer::spectral_ref {

/// Whether all that is left for a path is to find a light. Next-event estimation does that as well: far from all lights
/// the last direction of a diffuse surface is left out.
inline bool isLastVertex(const PreparedScene& prepared, int edge) {
  return edge + 1 == prepared.scene.integrator.maxDepth;
}

/// Russian roulette on the largest lane, the same for every hero, so that it changes no weight.
template <int C, bool kDispersive>
bool survives(const IntegratorSettings& settings, int edge, const PathRandom& random, Path<C, kDispersive>& path) {
  if (edge + 1 < settings.russianRoulette) {
    return true;
  }
  const float chance = std::min(1.0F, path.throughput.maxCoeff() * static_cast<float>(C) / path.heroSum);
  if (random.roulette() >= chance) {
    return false;
  }
  path.throughput /= chance;
  return true;
}

/// What plain diffuse surfaces do to paths, several at once: what PathIntegrator does to one, where neither densities
/// nor what lies between depend on the wavelength.
template <int C, bool kDispersive>
class DiffuseSurfaces {
 public:
  using Group = PathGroup<C, kDispersive>;

  static_assert(kRaysTogether <= LightChoice::kMostTogether);

  explicit DiffuseSurfaces(const PreparedScene& prepared)
      : m_prepared(prepared),
        m_onlyLight(prepared.lights.onlyRectangle()),
        m_isOff(kDispersive || prepared.materials.hasGels() || prepared.lights.empty()) {}

  /// Those of some paths that scatter() does all for.
  METAMER_ALWAYS_INLINE RayMask which(const Group& group, RayMask paths) const {
    RayMask plain = 0;
    if (!m_isOff) {
      forEachRay(paths, [&](std::size_t i) {
        plain |= m_prepared.materials.isPlain(group.hits.material[i]) ? RayMask{1} << i : 0U;
      });
    }
    return plain;
  }

  /// The paths' direct light, still to be tested, and their next directions. @return  those that go on
  /// @param others  paths whose rays stay as they are
  METAMER_ALWAYS_INLINE RayMask scatter(int edge, RayMask paths, RayMask others, Group& group,
                                        PathStarts<C>& starts) const {
    if constexpr (kDispersive) {
      return 0;
    } else {
      Surfaces surfaces;
      look(edge, paths, group, surfaces);
      if (surfaces.front == 0) {
        return 0;
      }
      addDirect(group, starts, surfaces);
      return surfaces.goOn != 0 ? goOn(edge, others, group, starts, surfaces) : 0;
    }
  }

 private:
  struct Surfaces {
    std::array<Lanes<C>, kRaysTogether> reflectances;
    RayMask front = 0;  ///< paths that come from where the surface reflects
    RayMask goOn = 0;   ///< those of them that have more edges
  };

  METAMER_ALWAYS_INLINE void look(int edge, RayMask paths, const Group& group, Surfaces& surfaces) const {
    const HitGroup& hits = group.hits;
    surfaces.front = paths & onFront(group.rays, hits);
    surfaces.goOn = surfaces.front;
    if (isLastVertex(m_prepared, edge)) {
      surfaces.goOn &= m_prepared.lightReach.areNear(hits);
    }
    forEachRay(surfaces.front, [&](std::size_t i) {
      surfaces.reflectances[i] =
          m_prepared.spectra.at(m_prepared.materials.colour(hits.material[i]), group.paths[i].lanes);
    });
  }

  /// Chooses a light for each path, and a point on it.
  /// @param entries  of the paths' lights
  /// @param areas    paths whose light has an area; `lights` tells of these
  /// @return  paths that have a light
  METAMER_ALWAYS_INLINE RayMask chooseLights(const Group& group, const PathStarts<C>& starts, const Surfaces& surfaces,
                                             EachRay<std::uint32_t>& entries, LightsOfGroup& lights,
                                             RayMask& areas) const {
    if (m_onlyLight != nullptr) {
      areas = surfaces.front;
      drawOnOnlyLight(starts, surfaces, lights);
      return surfaces.front;
    }
    std::array<LitPoint, kRaysTogether> points;
    std::array<std::uint32_t, kRaysTogether> bits{};
    std::array<LightChoice::Choice, kRaysTogether> choices;
    std::size_t count = 0;
    forEachRay(surfaces.front, [&](std::size_t i) {
      points[count] = {group.hits.position[i], group.hits.normal[i], false};
      bits[count++] = starts.paths[i].random.light();
    });
    m_prepared.lightChoice.choose({points.data(), count}, {bits.data(), count}, {choices.data(), count});
    RayMask found = 0;
    count = 0;
    forEachRay(surfaces.front, [&](std::size_t i) {
      const LightChoice::Choice& choice = choices[count++];
      if (!(choice.probability > 0.0F)) {
        return;
      }
      const RayMask bit = RayMask{1} << i;
      found |= bit;
      entries[i] = choice.entry;
      lights.chance[i] = choice.probability;
      lights.isShared[i] = (surfaces.goOn & bit) != 0 ? 1.0F : 0.0F;
      const Eigen::Vector2f place = starts.paths[i].random.onLight();
      if (const auto point = m_prepared.lights.areaPoint({choice.entry, place.x(), place.y()})) {
        lights.place.set(i, point->place);
        lights.area.set(i, point->area);
        areas |= bit;
      }
    });
    return found;
  }

  METAMER_ALWAYS_INLINE void drawOnOnlyLight(const PathStarts<C>& starts, const Surfaces& surfaces,
                                             LightsOfGroup& lights) const {
    EachRay<float> u{};
    EachRay<float> v{};
    forEachRay(surfaces.front, [&](std::size_t i) {
      const Eigen::Vector2f place = starts.paths[i].random.onLight();
      u[i] = place.x();
      v[i] = place.y();
      lights.isShared[i] = (surfaces.goOn & kRayBits[i]) != 0 ? 1.0F : 0.0F;
    });
    pointsOn(*m_onlyLight, u, v, lights);
  }

  METAMER_ALWAYS_INLINE void addDirect(Group& group, const PathStarts<C>& starts, const Surfaces& surfaces) const {
    EachRay<std::uint32_t> entries{};
    LightsOfGroup lights;
    RayMask areas = 0;
    const RayMask found = chooseLights(group, starts, surfaces, entries, lights, areas);
    lookAtLights(group.hits, lights, group.shadowRays);
    forEachRay(found & ~areas, [&](std::size_t i) {
      const Eigen::Vector2f place = starts.paths[i].random.onLight();
      const Hit hit = group.hits[i];
      const LightSample light = m_prepared.lights.located({entries[i], place.x(), place.y()}, hit.position);
      const float value = kInversePi * std::max(light.direction.dot(hit.normal), 0.0F);  // from behind: none
      // A point light is found by this technique alone.
      const float others = light.isDelta ? 0.0F : value * lights.isShared[i];
      lights.weight[i] = light.pdf > 0.0F ? value * light.scale / (light.pdf * lights.chance[i] + others) : 0.0F;
      group.shadowRays.set(i, shadowRay(hit, light));
    });
    forEachRay(found, [&](std::size_t i) {
      if (lights.weight[i] > 0.0F) {
        Path<C, kDispersive>& path = group.paths[i];
        path.direct = path.throughput * surfaces.reflectances[i] *
                      m_prepared.lights.radianceOf(entries[i], m_prepared.spectra, path.lanes) * lights.weight[i];
        group.lit |= isAnyAbove(path.direct) ? RayMask{1} << i : 0U;
      }
    });
  }

  METAMER_ALWAYS_INLINE RayMask goOn(int edge, RayMask others, Group& group, const PathStarts<C>& starts,
                                     const Surfaces& surfaces) const {
    EachRay<float> u{};
    EachRay<float> v{};
    forEachRay(surfaces.goOn, [&](std::size_t i) {
      const Eigen::Vector2f square = starts.paths[i].random.direction();
      u[i] = square.x();
      v[i] = square.y();
    });
    EachRay<float> pdf{};
    scatterDiffusely(group.hits, u, v, surfaces.goOn, others, group.rays, pdf);
    RayMask alive = 0;
    forEachRay(surfaces.goOn, [&](std::size_t i) {
      Path<C, kDispersive>& path = group.paths[i];
      path.throughput *= surfaces.reflectances[i];
      path.lastPdf = pdf[i];
      path.last = {group.hits.position[i], group.hits.normal[i], false};
      path.lastIsDelta = false;
      path.resampled = nullptr;
      const bool isAlive = pdf[i] > 0.0F && isAnyAbove(path.throughput) &&
                           survives(m_prepared.scene.integrator, edge, starts.paths[i].random, path);
      alive |= isAlive ? RayMask{1} << i : 0U;
    });
    return alive;
  }

  const PreparedScene& m_prepared;
  const RectangleEmitter* const m_onlyLight;  ///< null where there are others
  const bool m_isOff;
};

}  // namespace metamer::spectral_ref
