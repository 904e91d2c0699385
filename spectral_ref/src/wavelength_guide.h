// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <vector>

#include "lanes.h"
#include "metamer/spectral_ref/exact_sum.h"
#include "wavelength_table.h"

namespace metamer::spectral_ref {

/// Wavelength densities learnt from first samples that are not part of the film (4.2.3, 4.2.4).
///
/// What is learnt is how much each wavelength counts for luminance and the film's three responses together: w(lambda)
/// F(lambda), with w = |y| + |r_1| + |r_2| + |r_3|. The chapter takes |y| alone, which starves the other channels.
///
/// The picture has one density by 1 nm: what its lights let expect, scaled to what arrives; uniform where evenly
/// spaced, stratified lanes have little noise by wavelength anyhow. A pixel has a histogram of 20 bins of 20 nm,
/// smoothed across alike neighbours; where it is far from the picture's, it scales the density bin by bin. Once built,
/// densities stay as they are: so samples stay stratified by wavelength over the whole render. None is zero anywhere.
class WavelengthGuide {
 public:
  static constexpr int kBins = 20;
  static constexpr int kCellsABin = 20;  ///< the last bin has one more
  /// Samples a pixel that are learnt from.
  static constexpr std::uint32_t kLessons = 1;
  /// Part of the picture's density in that of every pixel. With the table's own uniform part no density is below
  /// 0.03 of the uniform one.
  static constexpr float kPictureShare = 0.3F;

  /// @param lanes     that a path carries
  /// @param expected  importance of each cell before anything is learnt, on any scale
  WavelengthGuide(int width, int height, int lanes, const spectral::DomainSamples& expected);

  /// Whether build() was called.
  bool isReady() const { return m_isReady; }

  /// What one thread learns by 1 nm over the whole picture.
  struct Spectrum {
    std::vector<ExactSum> worth = std::vector<ExactSum>(kCells);
    std::vector<std::uint64_t> paths = std::vector<std::uint64_t>(kCells);
  };
  /// Adds a path's w L / p of each lane to a pixel; one thread a pixel.
  template <int C>
  void learn(std::size_t pixel, const WavelengthSet<C>& wavelengths, const Lanes<C>& worth, Spectrum& spectrum) {
    float* bins = m_learnt.data() + pixel * kBins;
    for (int k = 0; k < C; ++k) {
      const auto cell = static_cast<std::size_t>(wavelengths.cell[static_cast<std::size_t>(k)]);
      if (worth[k] >= 0.0F && worth[k] < kLargest) {
        bins[binOf(cell)] += worth[k];
        spectrum.worth[cell].add(static_cast<double>(worth[k]));
        ++spectrum.paths[cell];
      }
    }
  }
  /// Adds what a tile has gathered. The order does not matter.
  void add(const Spectrum& spectrum);

  /// Builds the densities from what is learnt. Nothing more can be learnt afterwards.
  void build();

  /// The picture's density: before build(), what was expected.
  const WavelengthTable& picture() const { return m_picture; }
  /// Whether that is the uniform one.
  bool isUniform() const { return m_isUniform; }

  /// Density of a pixel that has its own.
  class PixelDensity {
   public:
    PixelDensity(const WavelengthGuide& guide, std::size_t pixel)
        : m_guide(guide), m_below(guide.m_below.data() + pixel * kBins) {}
    /// As WavelengthTable::sample.
    void sample(float u, float& nm, std::int32_t& cell, float& inverseDensity) const {
      // The bin: how many of the running sums lie at or below u.
      const float place = u * kUnits;
      int bin = -1;
      for (int i = 0; i < kBins; ++i) {
        bin += static_cast<float>(m_below[i]) <= place ? 1 : 0;
      }
      const float stretch = this->stretch(bin);
      const float start = m_guide.m_pictureBelow[static_cast<std::size_t>(bin)];
      const float end = m_guide.m_pictureBelow[static_cast<std::size_t>(bin) + 1];
      const float inPicture = start + (place - static_cast<float>(m_below[bin])) * stretch;
      m_guide.m_picture.sample(std::min(inPicture, std::nextafter(end, 0.0F)), nm, cell, inverseDensity);
      inverseDensity *= stretch * kUnits;
    }
    /// Per nm.
    float density(std::int32_t cell) const {
      return m_guide.m_picture.density(cell) /
             (stretch(static_cast<int>(binOf(static_cast<std::size_t>(cell)))) * kUnits);
    }

   private:
    /// Probability of the picture's density for one unit of the pixel's.
    float stretch(int bin) const {
      const auto i = static_cast<std::size_t>(bin);
      const float end = bin + 1 < kBins ? static_cast<float>(m_below[bin + 1]) : kUnits;
      return (m_guide.m_pictureBelow[i + 1] - m_guide.m_pictureBelow[i]) / (end - static_cast<float>(m_below[bin]));
    }
    const WavelengthGuide& m_guide;
    const std::uint16_t* m_below;
  };

  /// Whether a pixel draws from pixel(), not from picture().
  bool hasOwn(std::size_t pixel) const { return m_hasOwn[pixel] != 0; }
  PixelDensity pixel(std::size_t pixel) const { return {*this, pixel}; }
  /// Density that a pixel draws from, per nm by cell.
  spectral::DomainSamples density(std::size_t pixel) const;
  /// Learnt share of each bin in a pixel's w F, smoothed; whether or not it is drawn from.
  std::array<double, kBins> histogram(std::size_t pixel) const { return smoothed(pixel); }

 private:
  static constexpr float kLargest = 1e11F;
  static constexpr float kUnits = 65536.0F;  ///< running sums of a pixel's bins are whole numbers of 1/65536

  static constexpr int kBands = 5;
  using Bins = std::array<double, kBins>;
  using Bands = std::array<float, kBands>;  ///< of the spectrum, four bins each
  static std::size_t binOf(std::size_t cell) { return std::min(cell / kCellsABin, std::size_t{kBins - 1}); }
  std::size_t pixelOf(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(m_width) + static_cast<std::size_t>(x);
  }
  spectral::DomainSamples learntSpectrum() const;
  void averageBands();
  bool isUnlikePicture(std::size_t pixel) const;
  Bins smoothed(std::size_t pixel) const;
  void buildPixel(std::size_t pixel);

  int m_width;
  int m_height;
  int m_lanes;
  spectral::DomainSamples m_expected;
  WavelengthTable m_picture;
  std::array<float, kBins + 1> m_pictureBelow{};  ///< the picture's distribution function at the edges of bins
  std::vector<float> m_learnt;                    ///< [pixel][bin]
  Spectrum m_spectrum;
  Bins m_learntByPicture{};            ///< share of each bin, a little of all
  std::vector<Bands> m_bands;          ///< [pixel], mean over 3 x 3 pixels
  std::vector<std::uint16_t> m_below;  ///< [pixel][bin], density's integral below the bin
  std::vector<std::uint8_t> m_hasOwn;  ///< [pixel]
  bool m_isUniform = false;
  bool m_isReady = false;
  std::mutex m_mutex;
};

}  // namespace metamer::spectral_ref
