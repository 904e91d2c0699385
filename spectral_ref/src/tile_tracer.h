// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>

#include "film_sensor.h"
#include "path_integrator.h"

namespace metamer::spectral_ref {

struct Tile {
  int x0;
  int y0;
  int x1;
  int y1;
};

/// Takes samples of the pixels of a tile. One for each number of lanes, chosen once.
class TileTracer {
 public:
  virtual ~TileTracer() = default;
  /// Samples begin ... end - 1 of all pixels of a tile. Tiles may be traced at the same time.
  virtual void trace(const Tile& tile, std::uint64_t begin, std::uint64_t end, Film& film) = 0;
};

/// Names the random sequence of a pixel's replicate.
inline std::uint32_t sequenceOf(std::uint32_t seed, std::size_t pixel, std::size_t replicate) {
  return hash32(hash32(seed, static_cast<std::uint32_t>(pixel)), static_cast<std::uint32_t>(replicate));
}

template <int C>
std::unique_ptr<TileTracer> makeTileTracer(const PreparedScene& prepared, FilmSensor& sensor, std::uint32_t seed);

extern template std::unique_ptr<TileTracer> makeTileTracer<1>(const PreparedScene&, FilmSensor&, std::uint32_t);
extern template std::unique_ptr<TileTracer> makeTileTracer<4>(const PreparedScene&, FilmSensor&, std::uint32_t);
extern template std::unique_ptr<TileTracer> makeTileTracer<8>(const PreparedScene&, FilmSensor&, std::uint32_t);
extern template std::unique_ptr<TileTracer> makeTileTracer<16>(const PreparedScene&, FilmSensor&, std::uint32_t);

}  // namespace metamer::spectral_ref
