// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>

#include "integrator/diffuse_surfaces.h"
#include "integrator/gel_passage.h"
#include "integrator/path_random.h"
#include "integrator/path_state.h"
#include "integrator/prepared_scene.h"
#include "integrator/reservoir.h"
#include "metamer/spectral/vector_lanes.h"
#include "wavelengths/lanes.h"

namespace metamer::spectral_ref {

/// Direct light of the first surface by next-event estimation, as of all others.
struct NoResampling {
  static constexpr bool kResamples = false;
};

/// Radiance along camera rays at C wavelengths: path tracing with next-event estimation and BSDF sampling, combined by
/// the balance heuristic over path techniques and heroes (4.10).
///
/// Several paths are followed at once, edge by edge, so that Embree has their rays side by side.
///
/// `kDispersive` scenes have materials that send wavelengths different ways. In all others every density is the same
/// for all heroes and the weights collapse to 1/C; that is decided once, by the choice of this template.
template <int C, bool kDispersive>
class PathIntegrator {
 public:
  using Group = PathGroup<C, kDispersive>;

  static_assert(kRaysTogether <= Sampler::kMostTogether);

  explicit PathIntegrator(const PreparedScene& prepared)
      : m_prepared(prepared),
        m_settings(prepared.scene.integrator),
        m_hasGels(prepared.materials.hasGels()),
        m_diffuse(prepared) {}

  /// Follows paths; their radiance is in the group afterwards.
  /// @param resampling  of each path: gives the direct light of its first surface, where that is diffuse
  template <typename Resampling>
  METAMER_VECTOR_LANES void follow(PathStarts<C>& starts, const std::array<Resampling, kRaysTogether>& resampling,
                                   Group& group) const {
    group.rays = starts.rays;
    for (std::size_t i = 0; i < starts.count; ++i) {
      group.paths[i].begin(starts.paths[i].wavelengths);
    }
    RayMask alive = firstRays(starts.count);
    for (int edge = 1; alive != 0; ++edge) {
      const RayMask found = nextSurfaces(group, alive, edge == 1 ? Course::Alike : Course::Any);
      forEachRay(alive & ~found & ~group.absorbed,
                 [&](std::size_t i) { addEnvironment(group.rays[i], group.paths[i], resampling[i]); });
      forEachRay(found, [&](std::size_t i) {
        if (group.hits.emitter[i] != kNone) {
          addEmission(group.rays[i], group.hits[i], group.paths[i], resampling[i]);
        }
      });
      if (edge >= m_settings.maxDepth) {
        break;
      }
      toVertex(edge - 1, found, starts);
      group.lit = 0;
      const RayMask plain = Resampling::kResamples && edge == 1 ? RayMask{0} : m_diffuse.which(group, found);
      alive = m_diffuse.scatter(edge, plain, found & ~plain, group, starts);
      forEachRay(found & ~plain, [&](std::size_t i) {
        alive |= surface(edge, i, group, starts.paths[i], resampling[i]) ? RayMask{1} << i : 0U;
      });
      addDirect(group, edge == 1 ? Course::Alike : Course::Any);
    }
  }

  /// The diffuse surface that a camera ray sees, if it sees one.
  bool receiver(Ray ray, LitPoint& seen) const {
    Hit hit;
    while (m_prepared.shapes.intersect(ray, hit)) {
      if (!m_prepared.materials.isGel(hit.material)) {
        seen = {hit.position, hit.normal};
        return m_prepared.materials.isDiffuse(hit.material) && ray.direction.dot(hit.normal) < 0.0F;
      }
      ray.origin = offPoint(hit.position, hit.normal, ray.direction);
    }
    return false;
  }

 private:
  using Path = spectral_ref::Path<C, kDispersive>;

  static void toVertex(int number, RayMask paths, PathStarts<C>& starts) {
    std::array<PathRandom*, kRaysTogether> randoms{};
    std::size_t count = 0;
    forEachRay(paths, [&](std::size_t i) { randoms[count++] = &starts.paths[i].random; });
    PathRandom::vertex(static_cast<std::uint32_t>(number), {randoms.data(), count});
  }

  /// Follows paths to the next surface that scatters. @return  those that come to one
  RayMask nextSurfaces(Group& group, RayMask alive, Course course) const {
    group.absorbed = 0;
    if (!m_hasGels) {
      return m_prepared.shapes.intersect(group.rays, alive, group.hits, course);
    }
    RayMask found = 0;
    forEachRay(alive, [&](std::size_t i) {
      Path& path = group.paths[i];
      Ray ray = group.rays[i];
      Hit hit;
      const Passage passage = throughGels(m_prepared, ray, hit, path.throughput, path.lanes);
      group.rays.set(i, ray);
      if (passage == Passage::Hit) {
        group.hits.set(i, hit);
        found |= RayMask{1} << i;
      }
      group.absorbed |= passage == Passage::Absorbed ? RayMask{1} << i : 0U;
    });
    return found;
  }

  /// Adds the direct light that nothing lies in the way of.
  void addDirect(Group& group, Course course) const {
    if (group.lit == 0) {
      return;
    }
    if (!m_hasGels) {
      const RayMask hidden = m_prepared.shapes.occluded(group.shadowRays, group.lit, course);
      forEachRay(group.lit & ~hidden, [&](std::size_t i) { group.paths[i].radiance += group.paths[i].direct; });
      return;
    }
    forEachRay(group.lit, [&](std::size_t i) {
      Path& path = group.paths[i];
      if (gelsTransmit(m_prepared, group.shadowRays[i], path.emitter, path.direct, path.lanes)) {
        path.radiance += path.direct;
      }
    });
  }

  /// What a surface does to a path: its direct light, still to be tested, and the next direction.
  /// @return  false where the path ends
  template <typename Resampling>
  bool surface(int edge, std::size_t i, Group& group, const PathStart<C>& start, const Resampling& resampling) const {
    const Hit hit = group.hits[i];
    Path& path = group.paths[i];
    const Frame frame(hit.normal);
    const Vec3 out = frame.toLocal(-group.rays[i].direction);
    auto bsdf = m_prepared.materials.template bsdf<C, kDispersive>(hit.material, m_prepared.spectra, path.lanes);
    if (bsdf.isBlack(out)) {
      return false;
    }
    const PathRandom& random = start.random;
    if (const ReflectanceTexture* texture = m_prepared.materials.texture(hit.material)) {
      bsdf.setDiffuseReflectance(texture->template at<C>(hit, path.lanes));
    }
    if (const FluorescenceTable* fluorescence = m_prepared.materials.fluorescence(hit.material)) {
      bsdf.setDiffuseReflectance(fluorescence->template stayOrShift<C>(random.fluorescence(), path.throughput,
                                                                       bsdf.diffuseReflectance(), path.lanes));
    }
    bool isResampled = false;
    bool isLast = false;
    if constexpr (Resampling::kResamples) {
      path.resampled = nullptr;
      if (edge == 1 && m_prepared.materials.isDiffuse(hit.material)) {
        isResampled = true;
        if (!addResampledLight(i, group, bsdf, start, resampling)) {
          return false;
        }
      }
    }
    if (!isResampled && !bsdf.isDelta() && !m_prepared.lights.empty()) {
      isLast = m_prepared.materials.isDiffuse(hit.material) && isLastVertex(m_prepared, edge) &&
               !m_prepared.lightReach.isNear(hit.position);
      addDirectLight(i, group, frame, out, bsdf, random, !isLast);
    }
    Ray next;
    if (isLast || !scatter(hit, frame, out, bsdf, random, path, next)) {
      return false;
    }
    group.rays.set(i, next);
    return survives(m_settings, edge, random, path);
  }

  /// Weight of light found by following the BSDF, where next-event estimation finds it with density p_light:
  /// C p_bsdf / (sum of p_bsdf + sum of p_light over heroes). `density` is p_light once the entry is chosen.
  template <typename Density, typename Resampling>
  float weightOfFound(const Path& path, std::uint32_t entry, const Density& density,
                      const Resampling& resampling) const {
    if constexpr (Resampling::kResamples) {
      if (path.resampled != nullptr) {
        return resampling.sampler->bsdfWeight(*path.resampled, entry, density(), path.lastPdf);
      }
    }
    const float others = path.lastIsDelta ? 0.0F
                                          : m_prepared.lightChoice.probability(path.last, entry) * density() /
                                                path.lastPdf * path.heroSumBefore;
    return static_cast<float>(C) / (path.heroSum + others);
  }

  template <typename Resampling>
  void addEmission(const Ray& ray, const Hit& hit, Path& path, const Resampling& resampling) const {
    if (ray.direction.dot(hit.normal) >= 0.0F) {
      return;
    }
    const LightTable& lights = m_prepared.lights;
    const auto density = [&] { return lights.locatedPdf(hit, path.last.place, ray.direction); };
    const float weight = weightOfFound(path, lights.entryOf(hit), density, resampling);
    path.radiance +=
        path.throughput * lights.radiance(hit.emitter, lights.elementOf(hit), m_prepared.spectra, path.lanes) * weight;
  }

  template <typename Resampling>
  void addEnvironment(const Ray& ray, Path& path, const Resampling& resampling) const {
    const LightTable& lights = m_prepared.lights;
    if (!lights.hasEnvironment()) {
      return;
    }
    const auto density = [&] { return lights.locatedEnvironmentPdf(ray.direction); };
    const float weight = weightOfFound(path, lights.environmentEntry(ray.direction), density, resampling);
    path.radiance += path.throughput *
                     lights.radiance(lights.environmentEmitter(), lights.environmentElement(ray.direction),
                                     m_prepared.spectra, path.lanes) *
                     weight;
  }

  /// @param isShared  whether following the BSDF may find the light as well
  template <typename Bsdf>
  void addDirectLight(std::size_t i, Group& group, const Frame& frame, const Vec3& out, const Bsdf& bsdf,
                      const PathRandom& random, bool isShared) const {
    const Hit hit = group.hits[i];
    Path& path = group.paths[i];
    const LightTable& lights = m_prepared.lights;
    const LightChoice::Choice choice = m_prepared.lightChoice.choose(litPoint(hit, bsdf), random.light());
    if (!(choice.probability > 0.0F)) {
      return;
    }
    const Eigen::Vector2f place = random.onLight();
    LightSample light = lights.located({choice.entry, place.x(), place.y()}, hit.position);
    light.pdf *= choice.probability;
    if (!(light.pdf > 0.0F)) {
      return;
    }
    const BsdfValue<C, kDispersive> value = bsdf.evaluate(out, frame.toLocal(light.direction));
    // A point light is found by this technique alone.
    const float bsdfSum = light.isDelta || !isShared ? 0.0F : sumOverHeroes<C>(value.pdf * path.heroes);
    path.direct = path.throughput * value.value *
                  lights.radiance(light.emitter, light.element, m_prepared.spectra, path.lanes) *
                  (light.scale * static_cast<float>(C)) / (light.pdf * path.heroSum + bsdfSum);
    testLater(i, group, light);
  }

  /// The same with the point of a reservoir: f W (4.3.3), with the lanes weighed by (4.21) where the hero chose alone.
  /// @return  false where nothing is left for the path to find
  template <typename Bsdf, typename Resampling>
  bool addResampledLight(std::size_t i, Group& group, const Bsdf& bsdf, const PathStart<C>& start,
                         const Resampling& resampling) const {
    Path& path = group.paths[i];
    const Lanes<C> reflected = path.throughput * bsdf.diffuseReflectance();
    // The film sees the wavelengths that the path began with, whatever it has been shifted to.
    const Reservoir<C>& reservoir =
        resampling.fill(group.hits[i], reflected, path.lanes, start.wavelengths, start.random);
    path.resampled = &reservoir.domain;
    if (reservoir.contribution > 0.0F) {
      const auto point = resampling.sampler->look(reservoir.point, reservoir.domain);
      const Lanes<C> arriving = reflected * m_prepared.lights.radiance(point.light.emitter, point.light.element,
                                                                       m_prepared.spectra, path.lanes);
      float weight = point.geometry * reservoir.contribution;
      if (resampling.isHero) {
        const float sum = arriving.sum();
        weight *= sum > 0.0F ? static_cast<float>(C) * arriving[0] / sum : 0.0F;
      }
      path.direct = arriving * weight;
      testLater(i, group, point.light);
    }
    return m_settings.maxDepth > 2 || resampling.sampler->needsBsdf(reservoir.domain);
  }

  /// Notes the path's direct light for addDirect(), if there is any.
  static void testLater(std::size_t i, Group& group, const LightSample& light) {
    Path& path = group.paths[i];
    if (path.direct.maxCoeff() > 0.0F) {
      path.emitter = light.emitter;
      group.shadowRays.set(i, shadowRay(group.hits[i], light));
      group.lit |= RayMask{1} << i;
    }
  }

  template <typename Bsdf>
  static LitPoint litPoint(const Hit& hit, const Bsdf& bsdf) {
    return {hit.position, hit.normal, bsdf.isTwoSided()};
  }

  /// Draws the next direction; false where the path ends.
  template <typename Bsdf>
  static bool scatter(const Hit& hit, const Frame& frame, const Vec3& out, const Bsdf& bsdf, const PathRandom& random,
                      Path& path, Ray& ray) {
    const Eigen::Vector2f square = random.direction();
    const BsdfSample<C, kDispersive> sample = bsdf.sample(out, square.x(), square.y(), [&] { return random.lobe(); });
    const float pdf = heroDensity(sample.pdf);
    path.throughput *= sample.weight;
    if (!(pdf > 0.0F) || !(path.throughput.maxCoeff() > 0.0F)) {
      return false;
    }
    path.heroSumBefore = path.heroSum;
    if constexpr (kDispersive) {
      path.heroes *= sample.pdf / pdf;
      path.heroSum = path.heroes.sum();
    }
    path.lastPdf = pdf;
    path.last = litPoint(hit, bsdf);
    path.lastIsDelta = sample.isDelta;
    ray.direction = frame.toWorld(sample.direction);
    ray.origin = offPoint(hit.position, hit.normal, ray.direction);
    return true;
  }

  const PreparedScene& m_prepared;
  const IntegratorSettings& m_settings;
  const bool m_hasGels;
  const DiffuseSurfaces<C, kDispersive> m_diffuse;
};

}  // namespace metamer::spectral_ref
