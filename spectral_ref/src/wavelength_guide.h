// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <vector>

#include "lanes.h"
#include "metamer/spectral_ref/exact_sum.h"
#include "state_bytes.h"

namespace metamer::spectral_ref {

/// Wavelength densities learnt from the first samples (4.2.3, 4.2.4).
///
/// A pixel has a histogram of |y(lambda)| F(lambda) over 20 bins of 20 nm, smoothed across alike neighbours. Within a
/// bin its density has the shape, by 1 nm, of the whole picture's: lines of a lamp are the same for all that it lights,
/// and a reflectance hardly changes over 20 nm. A share of the density stays uniform, so that it is nowhere zero.
/// Pixels whose light is so even that evenly spaced lanes have little noise by wavelength stay uniform altogether.
class WavelengthGuide {
 public:
  static constexpr int kBins = 20;
  static constexpr int kCellsABin = 20;  ///< the last bin has one more
  /// Samples after which the densities are built, then built anew; no more is learnt after the last.
  static constexpr std::array<std::uint64_t, 2> kBuilds = {8, 32};
  /// Uniform part of the density (the defensive share).
  static constexpr float kDefensive = 0.1F;

  /// @param lanes  that a path carries
  WavelengthGuide(int width, int height, int lanes);

  bool isLearning(std::uint64_t sample) const { return sample < kBuilds.back(); }
  bool isReady() const { return m_isReady; }

  /// Adds a path's |y| L / p of each lane to a pixel; one thread a pixel.
  template <int C>
  void learn(std::size_t pixel, const WavelengthSet<C>& wavelengths, const Lanes<C>& luminance,
             std::vector<ExactSum>& fine) {
    float* bins = m_learnt.data() + pixel * kBins;
    for (int k = 0; k < C; ++k) {
      const std::int32_t cell = wavelengths.cell[static_cast<std::size_t>(k)];
      if (luminance[k] > 0.0F && luminance[k] < kLargest) {
        bins[binOf(cell)] += luminance[k];
        fine[static_cast<std::size_t>(cell)].add(static_cast<double>(luminance[k]));
      }
    }
  }
  /// Adds what a tile has gathered by 1 nm. The order does not matter.
  void addFine(const std::vector<ExactSum>& fine);

  /// Builds the densities from what is learnt.
  void build();

  /// Density of one pixel.
  class Density {
   public:
    Density(const WavelengthGuide& guide, std::size_t pixel)
        : m_guide(guide), m_below(guide.m_bins.data() + pixel * kBins), m_isUniform(guide.m_isUniform[pixel] != 0) {}
    /// As UniformWavelengths::sample.
    void sample(float u, float& nm, std::int32_t& cell, float& inverseDensity) const;
    /// Per nm.
    float density(std::int32_t cell) const;

   private:
    const WavelengthGuide& m_guide;
    const std::uint16_t* m_below;
    bool m_isUniform;
  };
  Density density(std::size_t pixel) const { return {*this, pixel}; }

  void save(StateWriter& writer) const;
  void restore(StateReader& reader);

 private:
  static constexpr float kLargest = 1e11F;
  static constexpr float kUnits = 65536.0F;  ///< running sums of a pixel's bins are whole numbers of 1/65536
  static constexpr float kUniformCell = kDefensive / static_cast<float>(kCells);

  static std::size_t binOf(std::int32_t cell) {
    return static_cast<std::size_t>(std::min(cell / kCellsABin, kBins - 1));
  }
  static int firstCell(int bin) { return bin * kCellsABin; }
  static int endCell(int bin) { return bin + 1 < kBins ? (bin + 1) * kCellsABin : kCells; }
  double uniformVariance(const std::array<double, kBins>& bins) const;
  void smoothed(int x, int y, std::array<double, kBins>& bins) const;

  int m_width;
  int m_height;
  int m_lanes;
  std::vector<float> m_learnt;            ///< [pixel][bin]
  std::vector<ExactSum> m_fine;           ///< [cell], of the whole picture
  std::vector<std::uint16_t> m_bins;      ///< [pixel][bin], density's integral below the bin
  std::vector<std::uint8_t> m_isUniform;  ///< [pixel]
  std::vector<float> m_within;            ///< [cell], probability of the cell within its bin
  std::vector<float> m_belowCell;  ///< [cell + bin], probability within the bin below the cell; 1 behind the last
  bool m_isReady = false;
  std::mutex m_mutex;
};

}  // namespace metamer::spectral_ref
