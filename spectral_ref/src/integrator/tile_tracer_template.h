// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <type_traits>
#include <vector>

#include "film/gathered_responses.h"
#include "integrator/edge_map.h"
#include "integrator/path_integrator.h"
#include "integrator/path_random.h"
#include "integrator/reservoir.h"
#include "integrator/tile_tracer.h"
#include "metamer/spectral/vector_lanes.h"
#include "wavelengths/wavelength_sampling.h"

namespace metamer::spectral_ref {

/// Paths that are followed side by side, of neighbouring pixels: part `part` of the `parts` that a sample is the mean
/// of.
struct PixelGroup {
  struct Place {
    int x = 0;
    int y = 0;
    std::size_t pixel = 0;
    std::uint32_t part = 0;
    std::uint32_t parts = 1;
    float share = 1.0F;  ///< of the sample: one of the parts
  };
  std::size_t count = 0;
  std::array<Place, kRaysTogether> places;
};

/// Plain path tracing.
template <int C, bool kDispersive>
class LaneTracer : public TileTracer {
 public:
  explicit LaneTracer(const TracerContext& context)
      : m_context(context),
        m_integrator(context.prepared),
        m_edges(context.prepared),
        m_spread(kDispersive || context.options.restir == Restir::Hero ? Spread::Hero : Spread::Lanes) {}

  void prepare(const Tile& tile) override {
    for (int y = tile.y0; y < tile.y1; ++y) {
      for (int x = tile.x0; x < tile.x1; ++x) {
        m_edges.look(x, y);
      }
    }
  }

  void learn(const Tile& tile) override {
    WavelengthGuide& guide = *m_context.guide;
    WavelengthGuide::Spectrum spectrum;
    PathStarts<C> starts;
    Group group;
    const auto parts = [&](int x, int y) { return guide.isLearntFrom(x, y) ? 1U : 0U; };
    forGroups(tile, parts, [&](const PixelGroup& pixels) {
      // Random numbers of no replicate of the film: it does not depend on what was learnt from them.
      const Sequences sequences(m_context.options.seed, pixels, kReplicates);
      startPaths(pixels, sequences, 0, starts);
      m_integrator.follow(starts, kNoResampling, group);
      for (std::size_t i = 0; i < pixels.count; ++i) {
        const WavelengthSet<C>& wavelengths = starts.paths[i].wavelengths;
        Lanes<C> worth = group.paths[i].radiance;
        for (int k = 0; k < C; ++k) {
          worth[k] *= wavelengths.weight[k] * m_context.sensor.worth(wavelengths.cell[static_cast<std::size_t>(k)]);
        }
        guide.learn<C>(guide.blockOf(pixels.places[i].x, pixels.places[i].y), wavelengths, worth, spectrum);
      }
    });
    guide.add(spectrum);
  }

  void trace(const Tile& tile, std::uint64_t begin, std::uint64_t end, bool isKept) override {
    const Replicates& replicates = m_context.film.format().replicates;
    FilmSums& sums = m_context.film.sums();
    PathStarts<C> starts;
    Group group;
    std::vector<GatheredResponses> gathered;
    const auto parts = [&](int x, int y) { return m_edges.paths(pixelOf(x, y)); };
    forGroups(tile, parts, [&](const PixelGroup& pixels) {
      std::array<std::optional<Sequences>, kReplicates> sequences;
      gathered.assign(pixels.count, GatheredResponses(sums.unitsInOne()));
      for (std::uint64_t sample = begin; sample < end; ++sample) {
        const std::size_t replicate = replicates.of(sample);
        if (!sequences[replicate]) {
          sequences[replicate].emplace(m_context.options.seed, pixels, replicate);
        }
        startPaths(pixels, *sequences[replicate], static_cast<std::uint32_t>(replicates.index(sample)), starts);
        follow(pixels, sample, starts, group);
        if (isKept) {
          gather(pixels, replicate, starts, group, gathered);
        }
      }
      for (std::size_t i = 0; i < pixels.count && isKept; ++i) {
        gathered[i].addTo(sums, pixels.places[i].pixel);
      }
    });
  }

 protected:
  using Integrator = PathIntegrator<C, kDispersive>;
  using Group = typename Integrator::Group;

  virtual void follow(const PixelGroup& /*pixels*/, std::uint64_t /*sample*/, PathStarts<C>& starts, Group& group) {
    m_integrator.follow(starts, kNoResampling, group);
  }

  std::size_t pixelOf(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(m_context.film.format().width) +
           static_cast<std::size_t>(x);
  }

  const TracerContext m_context;
  const Integrator m_integrator;

 private:
  static constexpr std::array<NoResampling, kRaysTogether> kNoResampling{};

  /// Random numbers of the pixels' replicate, with what they begin with worked out once.
  struct Sequences {
    Sequences(std::uint32_t seed, const PixelGroup& pixels, std::size_t replicate) {
      for (std::size_t i = 0; i < pixels.count; ++i) {
        numbers[i] = sequenceOf(seed, pixels.places[i].pixel, replicate);
      }
      Sampler::seed({numbers.data(), pixels.count}, 0, {first.data(), pixels.count});
    }
    std::array<std::uint32_t, kRaysTogether> numbers;
    std::array<Sampler::Seeds, kRaysTogether> first;
  };

  /// Deals the paths of a tile's pixels out in groups of neighbours. @param parts  paths of a pixel; 0: none
  template <typename Parts, typename Work>
  void forGroups(const Tile& tile, const Parts& parts, const Work& work) const {
    constexpr int kAcross = 4;
    constexpr int kDown = static_cast<int>(kRaysTogether) / kAcross;
    PixelGroup group;
    const auto finish = [&] {
      if (group.count > 0) {
        work(group);
        group.count = 0;
      }
    };
    for (int top = tile.y0; top < tile.y1; top += kDown) {
      for (int left = tile.x0; left < tile.x1; left += kAcross) {
        for (int i = 0; i < kAcross * kDown; ++i) {
          const int x = left + i % kAcross;
          const int y = top + i / kAcross;
          const std::uint32_t count = x < tile.x1 && y < tile.y1 ? parts(x, y) : 0U;
          for (std::uint32_t part = 0; part < count; ++part) {
            group.places[group.count++] = {x, y, pixelOf(x, y), part, count, 1.0F / static_cast<float>(count)};
            if (group.count == kRaysTogether) {
              finish();
            }
          }
        }
      }
    }
    finish();
  }

  METAMER_VECTOR_LANES void gather(const PixelGroup& pixels, std::size_t replicate, const PathStarts<C>& starts,
                                   const Group& group, std::vector<GatheredResponses>& gathered) const {
    for (std::size_t i = 0; i < pixels.count; ++i) {
      const PixelGroup::Place& place = pixels.places[i];
      m_context.sensor.template add<C>(m_context.film, gathered[i], place.pixel, replicate, starts.paths[i].wavelengths,
                                       group.paths[i].radiance * place.share);
    }
  }

  /// Random numbers, wavelengths and camera rays of a group's paths. @param index  of the sample in its sequence
  METAMER_VECTOR_LANES void startPaths(const PixelGroup& pixels, const Sequences& sequences, std::uint32_t index,
                                       PathStarts<C>& starts) const {
    std::array<Sampler::Order, kRaysTogether> orders;
    starts.count = pixels.count;
    for (std::size_t i = 0; i < pixels.count; ++i) {
      const PixelGroup::Place& at = pixels.places[i];
      const std::uint32_t number = index * at.parts + at.part;
      Sampler::Set& set = starts.paths[i].random.begin(Sampler(sequences.numbers[i], number));
      orders[i] = {number, &sequences.first[i], &set};
    }
    Sampler::fill({orders.data(), pixels.count});
    EachRay<int> x{};
    EachRay<int> y{};
    EachRay<float> u{};
    EachRay<float> v{};
    for (std::size_t i = 0; i < pixels.count; ++i) {
      const PixelGroup::Place& at = pixels.places[i];
      PathStart<C>& start = starts.paths[i];
      const Eigen::Vector2f square = start.random.pixel();
      x[i] = at.x;
      y[i] = at.y;
      u[i] = square.x();
      v[i] = square.y();
      start.wavelengths = wavelengthsOf(at.x, at.y, start.random.wavelength());
    }
    m_context.prepared.camera.filteredRays(x, y, u, v, starts.rays);
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

  EdgeMap m_edges;
  const Spread m_spread;
};

/// Path tracing whose direct light at the first surface, where that is diffuse, is resampled over progressions and
/// neighbours (4.3).
template <int C, bool kDispersive>
class ReservoirTracer : public LaneTracer<C, kDispersive> {
  using Base = LaneTracer<C, kDispersive>;

 public:
  explicit ReservoirTracer(const TracerContext& context)
      : Base(context),
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
    Base::prepare(tile);
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
  void follow(const PixelGroup& pixels, std::uint64_t sample, PathStarts<C>& starts,
              typename Base::Group& group) override {
    std::array<Resampling, kRaysTogether> resampling;
    std::array<Reservoir<C>, kRaysTogether> reservoirs;  // none filled yet
    for (std::size_t i = 0; i < pixels.count; ++i) {
      resampling[i] = {this, &m_sampler, &reservoirs[i], isHero(), pixels.places[i], sample};
    }
    this->m_integrator.follow(starts, resampling, group);
    // Of several paths of a pixel the last one leaves its reservoir to neighbours.
    for (std::size_t i = 0; i < pixels.count; ++i) {
      m_reservoirs[sample % 2][pixels.places[i].pixel] = reservoirs[i];
    }
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
    ReservoirTracer* tracer = nullptr;
    const ReservoirSampler<C>* sampler = nullptr;
    Reservoir<C>* own = nullptr;
    bool isHero = false;
    PixelGroup::Place place;
    std::uint64_t sample = 0;
    const Reservoir<C>& fill(const Hit& hit, const Lanes<C>& reflected, const WavelengthSet<C>& wavelengths,
                             const WavelengthSet<C>& seen, const PathRandom& random) const {
      return tracer->fill(*this, hit, reflected, wavelengths, seen, random);
    }
  };

  /// Independent numbers for choices among reservoirs.
  class HashRandom {
   public:
    HashRandom(std::uint32_t seed, const PixelGroup::Place& place, std::uint64_t sample)
        : m_key(
              hash32(hash32(hash32(seed, static_cast<std::uint32_t>(place.pixel)), static_cast<std::uint32_t>(sample)),
                     place.part)) {}
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
    domain.block = static_cast<std::uint32_t>(blockOf(at.place.x, at.place.y));
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
    Reservoir<C>& own = *at.own;
    own = m_sampler.fresh(domainOf(at, hit, reflected, wavelengths, seen),
                          random.candidates(ReservoirSampler<C>::kLog2Candidates), random.candidate());
    if (at.sample % kSamplesTogether == 0) {
      return own;
    }
    const std::vector<Reservoir<C>>& before = m_reservoirs[(at.sample + 1) % 2];
    const FilmFormat& format = this->m_context.film.format();
    HashRandom choices(this->m_context.options.seed, at.place, at.sample);
    for (int i = 0; i < kNeighbours; ++i) {
      // One by one: the order in which a call's arguments are worked out is the compiler's.
      const float across = choices.next();
      const float along = choices.next();
      const float u = choices.next();
      const Eigen::Vector2f offset = squareToDisc(across, along) * kRadius;
      const int x = at.place.x + static_cast<int>(std::lround(offset.x()));
      const int y = at.place.y + static_cast<int>(std::lround(offset.y()));
      if (x < 0 || y < 0 || x >= format.width || y >= format.height || (x == at.place.x && y == at.place.y)) {
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
