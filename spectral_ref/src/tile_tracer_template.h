// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tile_tracer.h"
#include "wavelength_sampling.h"

namespace metamer::spectral_ref {

template <int C, bool kDispersive>
class LaneTracer : public TileTracer {
 public:
  LaneTracer(const PreparedScene& prepared, FilmSensor& sensor, std::uint32_t seed)
      : m_prepared(prepared), m_sensor(sensor), m_seed(seed), m_integrator(prepared) {}

  void trace(const Tile& tile, std::uint64_t begin, std::uint64_t end, Film& film) override {
    const Replicates& replicates = film.format().replicates;
    for (int y = tile.y0; y < tile.y1; ++y) {
      for (int x = tile.x0; x < tile.x1; ++x) {
        const std::size_t pixel =
            static_cast<std::size_t>(y) * static_cast<std::size_t>(film.format().width) + static_cast<std::size_t>(x);
        for (std::uint64_t sample = begin; sample < end; ++sample) {
          const std::size_t replicate = replicates.of(sample);
          PathRandom random(
              Sampler(sequenceOf(m_seed, pixel, replicate), static_cast<std::uint32_t>(replicates.index(sample))));
          const Eigen::Vector2f place = m_prepared.camera.filtered(x, y, random.pixel());
          const auto wavelengths = sampleWavelengths<C>(UniformWavelengths(), random.wavelength());
          const Ray ray = m_prepared.camera.ray(place.x(), place.y());
          m_sensor.add<C>(film, pixel, replicate, wavelengths, m_integrator.radiance(ray, wavelengths, random));
        }
      }
    }
  }

 private:
  const PreparedScene& m_prepared;
  FilmSensor& m_sensor;
  std::uint32_t m_seed;
  PathIntegrator<C, kDispersive> m_integrator;
};

template <int C>
std::unique_ptr<TileTracer> makeTileTracer(const PreparedScene& prepared, FilmSensor& sensor, std::uint32_t seed) {
  if (prepared.materials.isDispersive()) {
    return std::make_unique<LaneTracer<C, true>>(prepared, sensor, seed);
  }
  return std::make_unique<LaneTracer<C, false>>(prepared, sensor, seed);
}

}  // namespace metamer::spectral_ref
