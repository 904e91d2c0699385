// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <type_traits>
#include <vector>

#include "reservoir.h"
#include "tile_tracer.h"
#include "wavelength_sampling.h"

namespace metamer::spectral_ref {

/// What a path starts with.
template <int C>
struct PathStart {
  PathRandom random;
  WavelengthSet<C> wavelengths;
  Ray ray;
};

/// Plain path tracing.
template <int C, bool kDispersive>
class LaneTracer : public TileTracer {
 public:
  explicit LaneTracer(const TracerContext& context)
      : m_context(context),
        m_integrator(context.prepared),
        m_spread(kDispersive || context.options.restir == Restir::Hero ? Spread::Hero : Spread::Lanes) {}

  void learn(const Tile& tile) override {
    WavelengthGuide& guide = *m_context.guide;
    WavelengthGuide::Spectrum spectrum;
    for (int y = tile.y0; y < tile.y1; ++y) {
      for (int x = tile.x0; x < tile.x1; ++x) {
        for (std::uint32_t lesson = 0; lesson < WavelengthGuide::kLessons; ++lesson) {
          // Random numbers of no replicate of the film: it does not depend on what was learnt from them.
          PathStart<C> start = startOf(x, y, kReplicates, lesson);
          Lanes<C> worth = m_integrator.radiance(start.ray, start.wavelengths, start.random);
          for (int k = 0; k < C; ++k) {
            worth[k] *= start.wavelengths.weight[k] *
                        m_context.sensor.worth(start.wavelengths.cell[static_cast<std::size_t>(k)]);
          }
          guide.learn<C>(pixelOf(x, y), start.wavelengths, worth, spectrum);
        }
      }
    }
    guide.add(spectrum);
  }

  void trace(const Tile& tile, std::uint64_t begin, std::uint64_t end, bool isKept) override {
    for (int y = tile.y0; y < tile.y1; ++y) {
      for (int x = tile.x0; x < tile.x1; ++x) {
        for (std::uint64_t sample = begin; sample < end; ++sample) {
          PathStart<C> start = startOf(x, y, sample);
          const Lanes<C> radiance = radianceOf(x, y, sample, start);
          if (isKept) {
            m_context.sensor.template add<C>(m_context.film, pixelOf(x, y),
                                             m_context.film.format().replicates.of(sample), start.wavelengths,
                                             radiance);
          }
        }
      }
    }
  }

 protected:
  virtual Lanes<C> radianceOf(int /*x*/, int /*y*/, std::uint64_t /*sample*/, PathStart<C>& start) {
    return m_integrator.radiance(start.ray, start.wavelengths, start.random);
  }

  std::size_t pixelOf(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(m_context.film.format().width) +
           static_cast<std::size_t>(x);
  }

  PathStart<C> startOf(int x, int y, std::uint64_t sample) const {
    const Replicates& replicates = m_context.film.format().replicates;
    return startOf(x, y, replicates.of(sample), replicates.index(sample));
  }

  const TracerContext m_context;
  const PathIntegrator<C, kDispersive> m_integrator;

 private:
  PathStart<C> startOf(int x, int y, std::size_t replicate, std::uint64_t index) const {
    const std::size_t pixel = pixelOf(x, y);
    const PathRandom random(
        Sampler(sequenceOf(m_context.options.seed, pixel, replicate), static_cast<std::uint32_t>(index)));
    const Eigen::Vector2f place = m_context.prepared.camera.filtered(x, y, random.pixel());
    return {random, wavelengthsOf(pixel, random.wavelength()), m_context.prepared.camera.ray(place.x(), place.y())};
  }

  WavelengthSet<C> wavelengthsOf(std::size_t pixel, float u) const {
    const WavelengthGuide* guide = m_context.guide;
    if (guide != nullptr && guide->hasOwn(pixel)) {
      return sampleWavelengths<C>(guide->pixel(pixel), u, m_spread);
    }
    return guide == nullptr || guide->isUniform() ? sampleWavelengths<C>(UniformWavelengths(), u, m_spread)
                                                  : sampleWavelengths<C>(guide->picture(), u, m_spread);
  }

  const Spread m_spread;
};

/// Path tracing whose direct light at the first surface, where that is diffuse, is resampled over progressions and
/// neighbours (4.3).
template <int C, bool kDispersive>
class ReservoirTracer : public LaneTracer<C, kDispersive> {
 public:
  explicit ReservoirTracer(const TracerContext& context)
      : LaneTracer<C, kDispersive>(context),
        m_sampler(context.prepared.lights, context.prepared.spectra),
        m_fresh(context.film.format().pixels()),
        m_kept(context.film.format().pixels()) {}

  bool resamples() const override { return true; }

  /// Fresh candidates, then the reservoir of the progression before.
  void prepare(const Tile& tile, std::uint64_t sample) override {
    for (int y = tile.y0; y < tile.y1; ++y) {
      for (int x = tile.x0; x < tile.x1; ++x) {
        const std::size_t pixel = this->pixelOf(x, y);
        m_fresh[pixel] = gathered(x, y, sample);
      }
    }
  }

  void save(StateWriter& writer) const override { writer.putAll(m_kept); }
  void restore(StateReader& reader) override { reader.getAll(m_kept); }

 protected:
  /// Three neighbours, then the path with the point that is left.
  Lanes<C> radianceOf(int x, int y, std::uint64_t sample, PathStart<C>& start) override {
    const std::size_t pixel = this->pixelOf(x, y);
    Reservoir<C>& kept = m_kept[pixel];
    kept = m_fresh[pixel];
    if (kept.confidence > 0.0F) {
      const FilmFormat& format = this->m_context.film.format();
      HashRandom random(this->m_context.options.seed, pixel, sample, kSpatialStream);
      for (int i = 0; i < kNeighbours; ++i) {
        const Eigen::Vector2f offset = squareToDisc(random.next(), random.next()) * kRadius;
        const float u = random.next();
        const int nx = x + static_cast<int>(std::lround(offset.x()));
        const int ny = y + static_cast<int>(std::lround(offset.y()));
        if (nx < 0 || ny < 0 || nx >= format.width || ny >= format.height || (nx == x && ny == y)) {
          continue;
        }
        const Reservoir<C>& other = m_fresh[this->pixelOf(nx, ny)];
        if (other.domain.normal().dot(kept.domain.normal()) > kLikeNormal) {
          m_sampler.merge(kept, other, other.confidence, u);
        }
      }
    }
    return this->m_integrator.radiance(start.ray, start.wavelengths, start.random, &kept,
                                       this->m_context.options.restir == Restir::Hero);
  }

 private:
  static constexpr int kCandidates = 8;
  static constexpr int kNeighbours = 3;
  static constexpr float kRadius = 10.0F;  ///< pixels
  static constexpr float kLikeNormal = 0.9F;
  static constexpr float kLongestHistory = 4.0F;  ///< progressions that the reservoir of the one before may stand for
  static constexpr std::uint32_t kFreshStream = 1;
  static constexpr std::uint32_t kSpatialStream = 2;
  static_assert(std::is_trivially_copyable_v<Reservoir<C>>);

  /// Independent numbers for choices among reservoirs.
  class HashRandom {
   public:
    HashRandom(std::uint32_t seed, std::size_t pixel, std::uint64_t sample, std::uint32_t stream)
        : m_key(hash32(hash32(seed, static_cast<std::uint32_t>(pixel)),
                       hash32(static_cast<std::uint32_t>(sample), stream))) {}
    std::uint32_t bits() { return hash32(m_key, ++m_count); }
    float next() { return unitFloat(bits()); }

   private:
    std::uint32_t m_key;
    std::uint32_t m_count = 0;
  };

  Reservoir<C> gathered(int x, int y, std::uint64_t sample) const {
    PathStart<C> start = this->startOf(x, y, sample);
    ReservoirDomain<C> domain;
    if (!this->m_integrator.resamplingDomain(start.ray, start.wavelengths, this->m_context.sensor,
                                             this->m_context.options.restir == Restir::Hero, domain)) {
      return {};
    }
    const std::size_t pixel = this->pixelOf(x, y);
    HashRandom random(this->m_context.options.seed, pixel, sample, kFreshStream);
    const LightTable& lights = this->m_context.prepared.lights;
    Reservoir<C> reservoir = m_sampler.fresh(domain, kCandidates, [&](int i) {
      // One candidate from each of as many equal parts of the lights.
      const auto bits = static_cast<std::uint32_t>(((static_cast<std::uint64_t>(i) << 32U) + random.bits()) /
                                                   static_cast<std::uint64_t>(kCandidates));
      const float u = random.next();
      const float v = random.next();
      return std::pair(lights.choose(bits, u, v), random.next());
    });
    if (sample % TileTracer::kEpoch != 0) {
      const Reservoir<C>& before = m_kept[pixel];
      m_sampler.merge(reservoir, before, std::min(before.confidence, kLongestHistory * kCandidates), random.next());
    }
    return reservoir;
  }

  ReservoirSampler<C> m_sampler;
  std::vector<Reservoir<C>> m_fresh;
  std::vector<Reservoir<C>> m_kept;
};

template <int C>
std::unique_ptr<TileTracer> makeTileTracer(const TracerContext& context) {
  const bool resamples = context.options.restir != Restir::Off && !context.prepared.lights.empty();
  if (context.prepared.materials.isDispersive()) {
    if (resamples) {
      return std::make_unique<ReservoirTracer<C, true>>(context);
    }
    return std::make_unique<LaneTracer<C, true>>(context);
  }
  if (resamples) {
    return std::make_unique<ReservoirTracer<C, false>>(context);
  }
  return std::make_unique<LaneTracer<C, false>>(context);
}

}  // namespace metamer::spectral_ref
