// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <type_traits>
#include <vector>

#include "integrator/path_integrator.h"
#include "integrator/path_random.h"
#include "integrator/reservoir.h"
#include "integrator/tile_tracer.h"
#include "wavelengths/wavelength_sampling.h"

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
        if (!guide.isLearntFrom(x, y)) {
          continue;
        }
        // Random numbers of no replicate of the film: it does not depend on what was learnt from them.
        PathStart<C> start = startOf(x, y, sequenceFor(pixelOf(x, y), kReplicates), 0);
        Lanes<C> worth = m_integrator.radiance(start.ray, start.wavelengths, start.random, NoResampling());
        for (int k = 0; k < C; ++k) {
          worth[k] *=
              start.wavelengths.weight[k] * m_context.sensor.worth(start.wavelengths.cell[static_cast<std::size_t>(k)]);
        }
        guide.learn<C>(guide.blockOf(x, y), start.wavelengths, worth, spectrum);
      }
    }
    guide.add(spectrum);
  }

  void trace(const Tile& tile, std::uint64_t begin, std::uint64_t end, bool isKept) override {
    const Replicates& replicates = m_context.film.format().replicates;
    std::vector<Place> places;
    for (std::uint64_t sample = begin; sample < end; ++sample) {
      places.push_back({replicates.of(sample), static_cast<std::uint32_t>(replicates.index(sample))});
    }
    for (int y = tile.y0; y < tile.y1; ++y) {
      for (int x = tile.x0; x < tile.x1; ++x) {
        const std::size_t pixel = pixelOf(x, y);
        std::array<std::optional<Sequence>, kReplicates> sequences;
        for (std::uint64_t sample = begin; sample < end; ++sample) {
          const Place& place = places[sample - begin];
          std::optional<Sequence>& sequence = sequences[place.replicate];
          if (!sequence) {
            sequence = sequenceFor(pixel, place.replicate);
          }
          PathStart<C> start = startOf(x, y, *sequence, place.index);
          const Lanes<C> radiance = radianceOf(x, y, sample, start);
          if (isKept) {
            m_context.sensor.template add<C>(m_context.film, pixel, place.replicate, start.wavelengths, radiance);
          }
        }
      }
    }
  }

 protected:
  virtual Lanes<C> radianceOf(int /*x*/, int /*y*/, std::uint64_t /*sample*/, PathStart<C>& start) {
    return m_integrator.radiance(start.ray, start.wavelengths, start.random, NoResampling());
  }

  std::size_t pixelOf(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(m_context.film.format().width) +
           static_cast<std::size_t>(x);
  }

  const TracerContext m_context;
  const PathIntegrator<C, kDispersive> m_integrator;

 private:
  /// Where a sample stands among those of its pixel.
  struct Place {
    std::size_t replicate;
    std::uint32_t index;
  };
  /// Random numbers of a pixel's replicate, with what they begin with worked out once.
  struct Sequence {
    explicit Sequence(std::uint32_t name) : number(name), first(name, 0) {}
    std::uint32_t number;
    Sampler::Seeds first;
  };

  Sequence sequenceFor(std::size_t pixel, std::size_t replicate) const {
    return Sequence(sequenceOf(m_context.options.seed, pixel, replicate));
  }

  PathStart<C> startOf(int x, int y, const Sequence& sequence, std::uint32_t index) const {
    const PathRandom random(Sampler(sequence.number, index), sequence.first);
    const Eigen::Vector2f place = m_context.prepared.camera.filtered(x, y, random.pixel());
    return {random, wavelengthsOf(x, y, random.wavelength()), m_context.prepared.camera.ray(place.x(), place.y())};
  }

  WavelengthSet<C> wavelengthsOf(int x, int y, float u) const {
    const WavelengthGuide* guide = m_context.guide;
    if (guide == nullptr) {
      return sampleWavelengths<C>(UniformWavelengths(), u, m_spread);
    }
    const std::size_t block = guide->blockOf(x, y);
    if (guide->hasOwn(block)) {
      return sampleWavelengths<C>(guide->own(block), u, m_spread);
    }
    return guide->isUniform() ? sampleWavelengths<C>(UniformWavelengths(), u, m_spread)
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
        m_blockSide(blockSideFor(context.film.format())),
        m_blocksAcross(blocksAlong(context.film.format().width, m_blockSide)),
        m_cuts(*context.prepared.tree, blocks(context.film.format(), m_blockSide)),
        m_sampler(context.prepared.lights, context.prepared.spectra, m_cuts) {
    for (std::vector<Reservoir<C>>& progression : m_reservoirs) {
      progression.resize(context.film.format().pixels());
    }
  }

  bool resamples() const override { return true; }

  /// The light cuts of the tile's blocks.
  void prepare(const Tile& tile) override {
    std::vector<LitPoint> receivers;
    for (int y = tile.y0; y < tile.y1; y += m_blockSide) {
      for (int x = tile.x0; x < tile.x1; x += m_blockSide) {
        receivers.clear();
        for (std::size_t i = 0; i < LightCuts::kReceivers; ++i) {
          // The centres of the block's quarters.
          const float px = static_cast<float>(x) + static_cast<float>(m_blockSide) * (i % 2 == 0 ? 0.25F : 0.75F);
          const float py = static_cast<float>(y) + static_cast<float>(m_blockSide) * (i / 2 == 0 ? 0.25F : 0.75F);
          LitPoint receiver;
          if (this->m_integrator.receiver(this->m_context.prepared.camera.ray(px, py), receiver)) {
            receivers.push_back(receiver);
          }
        }
        m_cuts.build(blockOf(x, y), receivers);
      }
    }
  }

  /// The progression before the next sample is all that is read again.
  void save(StateWriter& writer, std::uint64_t sample) const override { writer.putAll(m_reservoirs[(sample + 1) % 2]); }
  void restore(StateReader& reader, std::uint64_t sample) override { reader.getAll(m_reservoirs[(sample + 1) % 2]); }

 protected:
  Lanes<C> radianceOf(int x, int y, std::uint64_t sample, PathStart<C>& start) override {
    m_reservoirs[sample % 2][this->pixelOf(x, y)].confidence = 0.0F;
    return this->m_integrator.radiance(start.ray, start.wavelengths, start.random,
                                       Resampling{*this, m_sampler, isHero(), x, y, sample});
  }

 private:
  static constexpr int kNeighbours = 3;
  static constexpr float kRadius = 3.0F;  ///< pixels
  static constexpr float kLikeNormal = 0.9F;
  static constexpr std::size_t kMostCutBytes = std::size_t{1} << 27U;
  static_assert(std::is_trivially_copyable_v<Reservoir<C>>);

  /// What the integrator asks for at the first surface.
  struct Resampling {
    static constexpr bool kResamples = true;
    ReservoirTracer& tracer;
    const ReservoirSampler<C>& sampler;
    bool isHero;
    int x;
    int y;
    std::uint64_t sample;
    const Reservoir<C>& fill(const Hit& hit, const Lanes<C>& reflected, const WavelengthSet<C>& wavelengths,
                             const WavelengthSet<C>& seen, const PathRandom& random) const {
      return tracer.fill(*this, hit, reflected, wavelengths, seen, random);
    }
  };

  /// Independent numbers for choices among reservoirs.
  class HashRandom {
   public:
    HashRandom(std::uint32_t seed, std::size_t pixel, std::uint64_t sample)
        : m_key(hash32(hash32(seed, static_cast<std::uint32_t>(pixel)), static_cast<std::uint32_t>(sample))) {}
    float next() { return unitFloat(hash32(m_key, ++m_count)); }

   private:
    std::uint32_t m_key;
    std::uint32_t m_count = 0;
  };

  static int blocksAlong(int pixels, int side) { return (pixels + side - 1) / side; }
  static std::size_t blocks(const FilmFormat& format, int side) {
    return static_cast<std::size_t>(blocksAlong(format.width, side)) *
           static_cast<std::size_t>(blocksAlong(format.height, side));
  }
  /// As small as memory allows: lights nearby look different from pixel to pixel.
  static int blockSideFor(const FilmFormat& format) {
    int side = 2;
    while (side < kTileSide && blocks(format, side) * LightCuts::kBytesABlock > kMostCutBytes) {
      side *= 2;
    }
    return side;
  }

  bool isHero() const { return this->m_context.options.restir == Restir::Hero; }

  std::size_t blockOf(int x, int y) const {
    return static_cast<std::size_t>(y / m_blockSide) * static_cast<std::size_t>(m_blocksAcross) +
           static_cast<std::size_t>(x / m_blockSide);
  }

  ReservoirDomain<C> domainOf(const Resampling& at, const Hit& hit, const Lanes<C>& reflected,
                              const WavelengthSet<C>& wavelengths, const WavelengthSet<C>& seen) const {
    ReservoirDomain<C> domain;
    domain.block = static_cast<std::uint32_t>(blockOf(at.x, at.y));
    domain.place = {hit.position.x(), hit.position.y(), hit.position.z()};
    domain.up = {hit.normal.x(), hit.normal.y(), hit.normal.z()};
    for (int k = 0; k < C; ++k) {
      const auto lane = static_cast<std::size_t>(k);
      domain.cell[lane] = static_cast<std::int16_t>(wavelengths.cell[lane]);
      // Lanes: luminance, and a little of everything, so that a point is lost to no lane.
      constexpr float kInvisibleShare = 0.05F / static_cast<float>(kCells);
      const float luminance = std::abs(this->m_context.sensor.luminance(seen.cell[lane])) + kInvisibleShare;
      domain.factor[lane] = reflected[k] * luminance * seen.weight[k];
      if (at.isHero) {
        domain.factor[lane] = k == 0 ? reflected[0] : 0.0F;
      }
    }
    return domain;
  }

  /// Fresh candidates, then the reservoirs that three neighbours had in the progression before: reuse over pixels and
  /// progressions at once.
  ///
  /// A pixel's own reservoir is left out: what it would bring has been counted in this pixel already, so in the mean
  /// over progressions it only takes weight from what is new. Nor does a neighbour outweigh fresh ones.
  const Reservoir<C>& fill(const Resampling& at, const Hit& hit, const Lanes<C>& reflected,
                           const WavelengthSet<C>& wavelengths, const WavelengthSet<C>& seen,
                           const PathRandom& random) {
    const std::size_t pixel = this->pixelOf(at.x, at.y);
    Reservoir<C>& own = m_reservoirs[at.sample % 2][pixel];
    own = m_sampler.fresh(domainOf(at, hit, reflected, wavelengths, seen),
                          random.candidates(ReservoirSampler<C>::kLog2Candidates), random.candidate());
    if (at.sample % kSamplesTogether == 0) {
      return own;
    }
    const std::vector<Reservoir<C>>& before = m_reservoirs[(at.sample + 1) % 2];
    const FilmFormat& format = this->m_context.film.format();
    HashRandom choices(this->m_context.options.seed, pixel, at.sample);
    for (int i = 0; i < kNeighbours; ++i) {
      // One by one: the order in which a call's arguments are worked out is the compiler's.
      const float across = choices.next();
      const float along = choices.next();
      const float u = choices.next();
      const Eigen::Vector2f offset = squareToDisc(across, along) * kRadius;
      const int x = at.x + static_cast<int>(std::lround(offset.x()));
      const int y = at.y + static_cast<int>(std::lround(offset.y()));
      if (x < 0 || y < 0 || x >= format.width || y >= format.height || (x == at.x && y == at.y)) {
        continue;
      }
      const Reservoir<C>& other = before[this->pixelOf(x, y)];
      if (other.domain.normal().dot(own.domain.normal()) > kLikeNormal) {
        m_sampler.merge(own, other, std::min(other.confidence, ReservoirSampler<C>::kShare), u);
      }
    }
    return own;
  }

  int m_blockSide;  ///< pixels
  int m_blocksAcross;
  LightCuts m_cuts;
  ReservoirSampler<C> m_sampler;
  /// Of the progression at hand and the one before, in turn: so that a pixel reads what no other is writing.
  std::array<std::vector<Reservoir<C>>, 2> m_reservoirs;
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
