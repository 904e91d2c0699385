// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>

#include "film/film_sensor.h"
#include "integrator/prepared_scene.h"
#include "integrator/sampler.h"
#include "integrator/state_bytes.h"
#include "metamer/spectral_ref/renderer.h"
#include "wavelengths/wavelength_guide.h"

namespace metamer::spectral_ref {

inline constexpr int kTileSide = 16;
static_assert(kTileSide % FilmSums::kSegment == 0, "a thread has a tile");

struct Tile {
  int x0;
  int y0;
  int x1;
  int y1;
};

/// All that the tracers of a render share.
struct TracerContext {
  const PreparedScene& prepared;
  FilmSensor& sensor;
  Film& film;
  WavelengthGuide* guide;  ///< null without guiding
  RenderOptions options;
};

/// Takes samples of the pixels of a tile. One for each number of lanes, chosen once. Tiles may be traced at the same
/// time.
class TileTracer {
 public:
  virtual ~TileTracer() = default;
  /// Teaches the guide what the pixels of a tile see; before anything is traced.
  virtual void learn(const Tile& tile) = 0;
  /// Whether trace() takes one sample at a time, all tiles of one before any of the next.
  virtual bool resamples() const { return false; }
  /// Once for each tile, before any is traced.
  virtual void prepare(const Tile&) {}
  /// Samples begin ... end - 1 of all pixels of a tile. @param isKept  whether they go into the film
  virtual void trace(const Tile& tile, std::uint64_t begin, std::uint64_t end, bool isKept) = 0;
  /// What the next sample, number `sample`, takes from those before.
  virtual void save(StateWriter&, std::uint64_t /*sample*/) const {}
  virtual void restore(StateReader&, std::uint64_t /*sample*/) {}
};

/// Names the random sequence of a pixel's replicate.
inline std::uint32_t sequenceOf(std::uint32_t seed, std::size_t pixel, std::size_t replicate) {
  return hash32(hash32(seed, static_cast<std::uint32_t>(pixel)), static_cast<std::uint32_t>(replicate));
}

template <int C>
std::unique_ptr<TileTracer> makeTileTracer(const TracerContext& context);

extern template std::unique_ptr<TileTracer> makeTileTracer<1>(const TracerContext&);
extern template std::unique_ptr<TileTracer> makeTileTracer<4>(const TracerContext&);
extern template std::unique_ptr<TileTracer> makeTileTracer<8>(const TracerContext&);
extern template std::unique_ptr<TileTracer> makeTileTracer<16>(const TracerContext&);

}  // namespace metamer::spectral_ref
