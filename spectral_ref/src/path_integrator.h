// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "camera.h"
#include "embree_scene.h"
#include "film_sensor.h"
#include "lanes.h"
#include "light_table.h"
#include "material_table.h"
#include "metamer/spectral_ref/scene.h"
#include "reservoir.h"
#include "sampler.h"

namespace metamer::spectral_ref {

/// A scene made ready to trace: flat tables, built once, read by all threads.
struct PreparedScene {
  explicit PreparedScene(const Scene& description)
      : scene(description),
        shapes(description),
        spectra(description.spectra),
        materials(description),
        lights(description, shapes),
        camera(description.camera, description.film) {}

  const Scene& scene;
  EmbreeScene shapes;
  SpectrumTables spectra;
  MaterialTable materials;
  LightTable lights;
  Camera camera;
};

/// Random numbers of a path by use. Set 0 serves the camera and the first vertex; vertex n > 0 has set n.
class PathRandom {
 public:
  explicit PathRandom(const Sampler& sampler) : m_sampler(sampler), m_set(sampler.set(0)) {}

  Eigen::Vector2f pixel() const { return {m_set[0], m_set[1]}; }
  float wavelength() const { return m_set[2]; }

  /// Goes on to a vertex: before any of the below.
  void vertex(std::uint32_t number) {
    m_vertex = number;
    m_offset = 3;
    if (number > 0) {
      m_set = m_sampler.set(number);
      m_offset = 0;
    }
  }
  LightPoint light(const LightTable& lights) const {
    return lights.choose(m_set.bits[m_offset + 2], m_set[m_offset], m_set[m_offset + 1]);
  }
  Eigen::Vector2f direction() const { return {m_set[m_offset + 3], m_set[m_offset + 4]}; }
  /// Chooses among the candidates of resampling, in place of light().
  float candidate() const { return m_set[m_offset + 2]; }
  Sampler::Candidates candidates(unsigned log2Count) const { return m_sampler.candidates(kCandidateSet, log2Count); }
  float lobe() const { return m_vertex > 0 ? m_set[5] : m_sampler.random(0); }
  float roulette() const { return m_vertex > 0 ? m_set[6] : m_sampler.random(1); }

 private:
  static constexpr std::uint32_t kCandidateSet = 0x63616e64U;  ///< no vertex has this number

  Sampler m_sampler;
  Sampler::Set m_set;
  std::size_t m_offset = 3;
  std::uint32_t m_vertex = 0;
};

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
    for (int edge = 1;; ++edge) {
      Hit hit;
      const Passage passage = trace(ray, hit, path.throughput, wavelengths);
      if (passage == Passage::Absorbed) {
        break;
      }
      if (passage == Passage::Escaped) {
        addEnvironment(ray, path, wavelengths, resampling);
        break;
      }
      addEmission(ray, hit, path, wavelengths, resampling);
      if (edge >= m_settings.maxDepth) {
        break;
      }
      const Frame frame(hit.normal);
      const Vec3 out = frame.toLocal(-ray.direction);
      const auto bsdf =
          m_prepared.materials.template bsdf<C, kDispersive>(hit.material, m_prepared.spectra, wavelengths);
      if (bsdf.isBlack(out)) {
        break;
      }
      random.vertex(static_cast<std::uint32_t>(edge - 1));
      bool isResampled = false;
      if constexpr (Resampling::kResamples) {
        path.resampled = nullptr;
        if (edge == 1 && m_prepared.materials.isDiffuse(hit.material)) {
          isResampled = true;
          if (!addResampledLight(hit, bsdf, random, path, wavelengths, resampling)) {
            break;
          }
        }
      }
      if (!isResampled && !bsdf.isDelta() && !m_prepared.lights.empty()) {
        addDirectLight(hit, frame, out, bsdf, random.light(m_prepared.lights), path, wavelengths);
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
  bool receiver(Ray ray, Receiver& seen) const {
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
  enum class Passage { Hit, Escaped, Absorbed };

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
    Vec3 lastPosition = Vec3::Zero();
    bool lastIsDelta = true;  ///< next-event estimation could not have found what it hits
  };

  static Density<C, kDispersive> ones() {
    if constexpr (kDispersive) {
      return Lanes<C>::Ones();
    } else {
      return 1.0F;
    }
  }

  /// Follows a ray to the next surface that scatters, through gels, which count as no edge.
  Passage trace(Ray& ray, Hit& hit, Lanes<C>& throughput, const WavelengthSet<C>& wavelengths) const {
    while (m_prepared.shapes.intersect(ray, hit)) {
      if (!m_prepared.materials.isGel(hit.material)) {
        return Passage::Hit;
      }
      throughput *= m_prepared.spectra.at(m_prepared.materials.gelTransmittance(hit.material), wavelengths);
      if (!(throughput.maxCoeff() > 0.0F)) {
        return Passage::Absorbed;
      }
      ray.origin = offPoint(hit.position, hit.normal, ray.direction);
    }
    return Passage::Escaped;
  }

  /// What gels leave of the light between two points; false where something else lies between.
  bool transmits(Ray ray, std::uint32_t emitter, Lanes<C>& light, const WavelengthSet<C>& wavelengths) const {
    if (!m_prepared.materials.hasGels()) {
      return !m_prepared.shapes.occluded(ray);
    }
    Hit hit;
    while (m_prepared.shapes.intersect(ray, hit)) {
      if (hit.emitter == emitter) {
        return true;  // the light itself, found a little early
      }
      if (!m_prepared.materials.isGel(hit.material)) {
        return false;
      }
      light *= m_prepared.spectra.at(m_prepared.materials.gelTransmittance(hit.material), wavelengths);
      if (!(light.maxCoeff() > 0.0F)) {
        return false;
      }
      const Vec3 next = offPoint(hit.position, hit.normal, ray.direction);
      ray.most -= (next - ray.origin).dot(ray.direction);
      ray.origin = next;
    }
    return true;
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
    const float others =
        path.lastIsDelta ? 0.0F : m_prepared.lights.probability(entry) * density() / path.lastPdf * path.heroSumBefore;
    return static_cast<float>(C) / (path.heroSum + others);
  }

  template <typename Resampling>
  void addEmission(const Ray& ray, const Hit& hit, Path& path, const WavelengthSet<C>& wavelengths,
                   const Resampling& resampling) const {
    if (hit.emitter == kNone || ray.direction.dot(hit.normal) >= 0.0F) {
      return;
    }
    const LightTable& lights = m_prepared.lights;
    const auto density = [&] { return lights.locatedPdf(hit, path.lastPosition, ray.direction); };
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
  void addDirectLight(const Hit& hit, const Frame& frame, const Vec3& out, const Bsdf& bsdf, const LightPoint& point,
                      Path& path, const WavelengthSet<C>& wavelengths) const {
    const LightTable& lights = m_prepared.lights;
    const LightSample light = lights.sample(point, hit.position);
    if (!(light.pdf > 0.0F)) {
      return;
    }
    const BsdfValue<C, kDispersive> value = bsdf.evaluate(out, frame.toLocal(light.direction));
    if (!(value.value.maxCoeff() > 0.0F)) {
      return;
    }
    Lanes<C> arriving = lights.radiance(light.emitter, light.element, m_prepared.spectra, wavelengths) * light.scale;
    if (!(arriving.maxCoeff() > 0.0F) || !transmits(shadowRay(hit, light), light.emitter, arriving, wavelengths)) {
      return;
    }
    // A point light is found by this technique alone.
    const float bsdfSum = light.isDelta ? 0.0F : sumOverHeroes<C>(value.pdf * path.heroes);
    path.radiance +=
        path.throughput * value.value * arriving * static_cast<float>(C) / (light.pdf * path.heroSum + bsdfSum);
  }

  /// The same with the point of a reservoir: f W (4.3.3), with the lanes weighed by (4.21) where the hero chose alone.
  /// @return  false where nothing is left for the path to find
  template <typename Bsdf, typename Resampling>
  bool addResampledLight(const Hit& hit, const Bsdf& bsdf, const PathRandom& random, Path& path,
                         const WavelengthSet<C>& wavelengths, const Resampling& resampling) const {
    const Lanes<C> reflected = path.throughput * bsdf.diffuseReflectance();
    const Reservoir<C>& reservoir = resampling.fill(hit, reflected, wavelengths, random);
    path.resampled = &reservoir.domain;
    if (reservoir.contribution > 0.0F) {
      const auto seen = resampling.sampler.look(reservoir.point, reservoir.domain);
      Lanes<C> arriving = reflected * m_prepared.lights.radiance(seen.light.emitter, seen.light.element,
                                                                 m_prepared.spectra, wavelengths);
      float weight = seen.geometry * reservoir.contribution;
      if (resampling.isHero) {
        const float sum = arriving.sum();
        weight *= sum > 0.0F ? static_cast<float>(C) * arriving[0] / sum : 0.0F;
      }
      if (weight > 0.0F && transmits(shadowRay(hit, seen.light), seen.light.emitter, arriving, wavelengths)) {
        path.radiance += arriving * weight;
      }
    }
    return m_settings.maxDepth > 2 || resampling.sampler.needsBsdf(reservoir.domain);
  }

  static Ray shadowRay(const Hit& hit, const LightSample& light) {
    // Short of the light by more than float error.
    constexpr float kShort = 1.0F - 1e-4F;
    Ray ray;
    ray.origin = offPoint(hit.position, hit.normal, light.direction);
    ray.direction = light.direction;
    ray.most = light.distance;
    if (std::isfinite(light.distance)) {
      // From where it starts: a light close by must not hide itself.
      const Vec3 towards = hit.position + light.direction * light.distance - ray.origin;
      ray.most = towards.norm();
      ray.direction = towards / ray.most;
      ray.most *= kShort;
    }
    return ray;
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
    path.lastPosition = hit.position;
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
