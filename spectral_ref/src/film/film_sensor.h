// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "film/gathered_responses.h"
#include "metamer/spectral/vector_lanes.h"
#include "metamer/spectral_ref/film.h"
#include "wavelengths/lanes.h"

namespace metamer::spectral_ref {

/// Turns the radiance of paths into responses of the observer and spectral bins.
class FilmSensor {
 public:
  explicit FilmSensor(const FilmSettings& settings);

  /// Adds one path's radiance to a pixel, its responses by way of `gathered`. Not two threads on one pixel.
  /// A value that is no number or beyond what the film's sums hold is left out and counted.
  template <int C>
  METAMER_ALWAYS_INLINE void add(Film& film, GatheredResponses& gathered, std::size_t pixel, std::size_t replicate,
                                 const WavelengthSet<C>& wavelengths, const Lanes<C>& radiance) {
    const Lanes<C> values = radiance * wavelengths.weight;
    // One test for all: a lane that is no number or out of range shows in the sum of squares.
    const float size = values.square().sum();
    if (!(size < kLargestSquare)) {
      m_refused.fetch_add(1, std::memory_order_relaxed);
      return;
    }
    if (size == 0.0F) {
      return;
    }
    Eigen::Array4f response = Eigen::Array4f::Zero();
    for (int k = 0; k < C; ++k) {
      response += values[k] * m_curves[static_cast<std::size_t>(wavelengths.cell[static_cast<std::size_t>(k)])];
    }
    FilmSums& sums = film.sums();
    if (!gathered.add(replicate, response)) {
      addLarge(sums, pixel, replicate, response);
    }
    for (int k = 0; k < C && m_bins.count > 0; ++k) {
      const double place = (static_cast<double>(wavelengths.nm[k]) - m_bins.fromNm) / m_bins.stepNm + 0.5;
      if (place >= 0.0 && place < static_cast<double>(m_bins.count)) {
        sums.add(pixel, Film::kFirstBin + static_cast<std::size_t>(place), static_cast<double>(values[k]));
      }
    }
  }

  /// Y of a radiance of 1 in a cell.
  float luminance(std::int32_t cell) const { return m_curves[static_cast<std::size_t>(cell)][3]; }
  /// What a radiance of 1 in a cell adds to luminance and all three responses, none negative.
  float worth(std::int32_t cell) const { return m_curves[static_cast<std::size_t>(cell)].abs().sum(); }
  /// What worth() is the sum of, a row a cell.
  Eigen::Matrix<double, kCells, 4> channels() const;
  std::uint64_t refused() const { return m_refused.load(); }

 private:
  static constexpr float kLargestSquare = 1e22F;

  static void addLarge(FilmSums& sums, std::size_t pixel, std::size_t replicate, const Eigen::Array4f& response);

  SpectralBins m_bins;
  /// Responses 0, 1, 2 and luminance by cell: a radiance of 1 gives a luminance of 1.
  std::vector<Eigen::Array4f> m_curves;
  std::atomic<std::uint64_t> m_refused = 0;
};

}  // namespace metamer::spectral_ref
