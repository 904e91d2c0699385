// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>

#include "integrator/gel_passage.h"
#include "integrator/path_random.h"
#include "integrator/prepared_scene.h"
#include "integrator/reservoir.h"
#include "wavelengths/lanes.h"

namespace metamer::spectral_ref {

/// Direct light of the first surface by next-event estimation, as of all others.
struct NoResampling {
  static constexpr bool kResamples = false;
};

/// Radiance along a camera ray at C wavelengths: path tracing with next-event estimation and BSDF sampling, combined by
/// the balance heuristic over path techniques and heroes (4.10).
///
/// `kDispersive` scenes have materials that send wavelengths different ways. In all others every density is the same
/// for all heroes and the weights collapse to 1/C; that is decided once, by the choice of this template.
template <int C, bool kDispersive>
class PathIntegrator {
 public:
  explicit PathIntegrator(const PreparedScene& prepared)
      : m_prepared(prepared), m_settings(prepared.scene.integrator) {}

  /// @param resampling  gives the direct light of the first surface, where that is diffuse
  template <typename Resampling>
  Lanes<C> radiance(Ray ray, const WavelengthSet<C>& wavelengths, PathRandom& random,
                    const Resampling& resampling) const {
    Path path;
    WavelengthSet<C> lanes = wavelengths;  // that the path carries here: fluorescent surfaces shift them
    for (int edge = 1;; ++edge) {
      Hit hit;
      const Passage passage = throughGels(m_prepared, ray, hit, path.throughput, lanes);
      if (passage == Passage::Absorbed) {
        break;
      }
      if (passage == Passage::Escaped) {
        addEnvironment(ray, path, lanes, resampling);
        break;
      }
      addEmission(ray, hit, path, lanes, resampling);
      if (edge >= m_settings.maxDepth) {
        break;
      }
      const Frame frame(hit.normal);
      const Vec3 out = frame.toLocal(-ray.direction);
      auto bsdf = m_prepared.materials.template bsdf<C, kDispersive>(hit.material, m_prepared.spectra, lanes);
      if (bsdf.isBlack(out)) {
        break;
      }
      random.vertex(static_cast<std::uint32_t>(edge - 1));
      if (const FluorescenceTable* fluorescence = m_prepared.materials.fluorescence(hit.material)) {
        bsdf.setDiffuseReflectance(fluorescence->template stayOrShift<C>(random.fluorescence(), path.throughput,
                                                                         bsdf.diffuseReflectance(), lanes));
      }
      bool isResampled = false;
      if constexpr (Resampling::kResamples) {
        path.resampled = nullptr;
        if (edge == 1 && m_prepared.materials.isDiffuse(hit.material)) {
          isResampled = true;
          if (!addResampledLight(hit, bsdf, random, path, lanes, wavelengths, resampling)) {
            break;
          }
        }
      }
      if (!isResampled && !bsdf.isDelta() && !m_prepared.lights.empty()) {
        addDirectLight(hit, frame, out, bsdf, random, path, lanes);
      }
      if (!scatter(hit, frame, out, bsdf, random, path, ray)) {
        break;
      }
      if (edge + 1 >= m_settings.russianRoulette && !survives(random.roulette(), path)) {
        break;
      }
    }
    return path.radiance;
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
  /// What a path has become on its way from the camera.
  struct Path {
    Lanes<C> radiance = Lanes<C>::Zero();
    /// Product of BSDFs and cosines over the density of the path's directions with the hero that drew them.
    Lanes<C> throughput = Lanes<C>::Ones();
    /// The same density with each lane as hero, over that of the hero.
    Density<C, kDispersive> heroes = ones();
    float heroSum = static_cast<float>(C);          ///< over all heroes
    float heroSumBefore = static_cast<float>(C);    ///< the same before the last direction was drawn
    float lastPdf = 0;                              ///< of that direction, by the hero
    const ReservoirDomain<C>* resampled = nullptr;  ///< where its next-event estimation was resampled
    LitPoint last;
    bool lastIsDelta = true;  ///< next-event estimation could not have found what it hits
  };

  static Density<C, kDispersive> ones() {
    if constexpr (kDispersive) {
      return Lanes<C>::Ones();
    } else {
      return 1.0F;
    }
  }

  /// Weight of light found by following the BSDF, where next-event estimation finds it with density p_light:
  /// C p_bsdf / (sum of p_bsdf + sum of p_light over heroes). `density` is p_light once the entry is chosen.
  template <typename Density, typename Resampling>
  float weightOfFound(const Path& path, std::uint32_t entry, const Density& density,
                      const Resampling& resampling) const {
    if constexpr (Resampling::kResamples) {
      if (path.resampled != nullptr) {
        return resampling.sampler.bsdfWeight(*path.resampled, entry, density(), path.lastPdf);
      }
    }
    const float others = path.lastIsDelta ? 0.0F
                                          : m_prepared.lightChoice.probability(path.last, entry) * density() /
                                                path.lastPdf * path.heroSumBefore;
    return static_cast<float>(C) / (path.heroSum + others);
  }

  template <typename Resampling>
  void addEmission(const Ray& ray, const Hit& hit, Path& path, const WavelengthSet<C>& wavelengths,
                   const Resampling& resampling) const {
    if (hit.emitter == kNone || ray.direction.dot(hit.normal) >= 0.0F) {
      return;
    }
    const LightTable& lights = m_prepared.lights;
    const auto density = [&] { return lights.locatedPdf(hit, path.last.place, ray.direction); };
    const float weight = weightOfFound(path, lights.entryOf(hit), density, resampling);
    path.radiance +=
        path.throughput * lights.radiance(hit.emitter, lights.elementOf(hit), m_prepared.spectra, wavelengths) * weight;
  }

  template <typename Resampling>
  void addEnvironment(const Ray& ray, Path& path, const WavelengthSet<C>& wavelengths,
                      const Resampling& resampling) const {
    const LightTable& lights = m_prepared.lights;
    if (!lights.hasEnvironment()) {
      return;
    }
    const auto density = [&] { return lights.locatedEnvironmentPdf(ray.direction); };
    const float weight = weightOfFound(path, lights.environmentEntry(ray.direction), density, resampling);
    path.radiance += path.throughput *
                     lights.radiance(lights.environmentEmitter(), lights.environmentElement(ray.direction),
                                     m_prepared.spectra, wavelengths) *
                     weight;
  }

  template <typename Bsdf>
  void addDirectLight(const Hit& hit, const Frame& frame, const Vec3& out, const Bsdf& bsdf, const PathRandom& random,
                      Path& path, const WavelengthSet<C>& wavelengths) const {
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
    if (!(value.value.maxCoeff() > 0.0F)) {
      return;
    }
    Lanes<C> arriving = lights.radiance(light.emitter, light.element, m_prepared.spectra, wavelengths) * light.scale;
    if (!(arriving.maxCoeff() > 0.0F) ||
        !gelsTransmit(m_prepared, shadowRay(hit, light), light.emitter, arriving, wavelengths)) {
      return;
    }
    // A point light is found by this technique alone.
    const float bsdfSum = light.isDelta ? 0.0F : sumOverHeroes<C>(value.pdf * path.heroes);
    path.radiance +=
        path.throughput * value.value * arriving * static_cast<float>(C) / (light.pdf * path.heroSum + bsdfSum);
  }

  /// The same with the point of a reservoir: f W (4.3.3), with the lanes weighed by (4.21) where the hero chose alone.
  /// @param seen    the wavelengths that the film sees, whatever the path has been shifted to
  /// @return  false where nothing is left for the path to find
  template <typename Bsdf, typename Resampling>
  bool addResampledLight(const Hit& hit, const Bsdf& bsdf, const PathRandom& random, Path& path,
                         const WavelengthSet<C>& wavelengths, const WavelengthSet<C>& seen,
                         const Resampling& resampling) const {
    const Lanes<C> reflected = path.throughput * bsdf.diffuseReflectance();
    const Reservoir<C>& reservoir = resampling.fill(hit, reflected, wavelengths, seen, random);
    path.resampled = &reservoir.domain;
    if (reservoir.contribution > 0.0F) {
      const auto point = resampling.sampler.look(reservoir.point, reservoir.domain);
      Lanes<C> arriving = reflected * m_prepared.lights.radiance(point.light.emitter, point.light.element,
                                                                 m_prepared.spectra, wavelengths);
      float weight = point.geometry * reservoir.contribution;
      if (resampling.isHero) {
        const float sum = arriving.sum();
        weight *= sum > 0.0F ? static_cast<float>(C) * arriving[0] / sum : 0.0F;
      }
      if (weight > 0.0F &&
          gelsTransmit(m_prepared, shadowRay(hit, point.light), point.light.emitter, arriving, wavelengths)) {
        path.radiance += arriving * weight;
      }
    }
    return m_settings.maxDepth > 2 || resampling.sampler.needsBsdf(reservoir.domain);
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

  /// Russian roulette on the largest lane, the same for every hero, so that it changes no weight.
  static bool survives(float u, Path& path) {
    const float chance = std::min(1.0F, path.throughput.maxCoeff() * static_cast<float>(C) / path.heroSum);
    if (u >= chance) {
      return false;
    }
    path.throughput /= chance;
    return true;
  }

  const PreparedScene& m_prepared;
  const IntegratorSettings& m_settings;
};

}  // namespace metamer::spectral_ref
