// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <vector>

#include "metamer/spectral_ref/exact_sum.h"
#include "wavelengths/lanes.h"
#include "wavelengths/wavelength_table.h"

namespace metamer::spectral_ref {

/// Wavelength densities learnt from first samples that are not part of the film (4.2.3, 4.2.4).
///
/// What is learnt is how much each wavelength counts for luminance and the film's three responses together: w(lambda)
/// F(lambda), with w = |y| + |r_1| + |r_2| + |r_3|. The chapter takes |y| alone, which starves the other channels. What
/// is drawn from is balanced: each of the four has a quarter of it, spread as its own light is, so that a channel in
/// which a scene has little light is not left with few samples.
///
/// The picture has one density by 1 nm: what its lights let expect, scaled to what arrives; uniform where evenly
/// spaced, stratified lanes have little noise by wavelength anyhow. A block has a histogram of 20 bins of 20 nm,
/// smoothed across alike neighbours; where it is far from the picture's, it scales the density bin by bin. Once built,
/// densities stay as they are: so samples stay stratified by wavelength over the whole render. None is zero anywhere.
///
/// A block is a pixel; but where the lights alone ask for uniform lanes, so that only a rare surface could ask for
/// others, it is 2 x 2 pixels, and a path of one of them is enough to learn from. So it is in pictures of more than
/// four million pixels, for the memory's sake.
class WavelengthGuide {
 public:
  static constexpr int kBins = 20;
  static constexpr int kCellsABin = 20;  ///< the last bin has one more
  /// Part of the picture's density in that of every block. With the table's own uniform part no density is below
  /// 0.03 of the uniform one.
  static constexpr float kPictureShare = 0.3F;

  /// Sensitivity of each of the channels that w is the sum of, a row a cell, none negative.
  using Channels = Eigen::Matrix<double, kCells, Eigen::Dynamic>;

  /// @param lanes     that a path carries
  /// @param expected  importance of each cell before anything is learnt, on any scale
  /// @param channels  that are balanced; none: what is learnt is drawn from as it is
  WavelengthGuide(int width, int height, int lanes, const spectral::DomainSamples& expected,
                  const Channels& channels = Channels(kCells, 0));

  /// Whether build() was called.
  bool isReady() const { return m_isReady; }

  /// Of a pixel. @param x, y  from the top left
  std::size_t blockOf(int x, int y) const { return blockAt(x / m_side, y / m_side); }
  /// Whether a path of this pixel is to be learnt from: of one in each block.
  bool isLearntFrom(int x, int y) const { return x % m_side == 0 && y % m_side == 0; }

  /// What one thread learns by 1 nm over the whole picture.
  struct Spectrum {
    std::vector<ExactSum> worth = std::vector<ExactSum>(kCells);
    std::vector<std::uint64_t> paths = std::vector<std::uint64_t>(kCells);
  };
  /// Adds a path's w L / p of each lane to a block; one thread a block.
  template <int C>
  void learn(std::size_t block, const WavelengthSet<C>& wavelengths, const Lanes<C>& worth, Spectrum& spectrum) {
    float* bins = m_learnt.data() + block * kBins;
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

  /// Density of a block that has its own.
  class OwnDensity {
   public:
    OwnDensity(const WavelengthGuide& guide, std::size_t block)
        : m_guide(guide), m_below(guide.m_below.data() + block * kBins) {}
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
    /// Probability of the picture's density for one unit of the block's.
    float stretch(int bin) const {
      const auto i = static_cast<std::size_t>(bin);
      const float end = bin + 1 < kBins ? static_cast<float>(m_below[bin + 1]) : kUnits;
      return (m_guide.m_pictureBelow[i + 1] - m_guide.m_pictureBelow[i]) / (end - static_cast<float>(m_below[bin]));
    }
    const WavelengthGuide& m_guide;
    const std::uint16_t* m_below;
  };

  /// Whether a block draws from own(), not from picture().
  bool hasOwn(std::size_t block) const { return m_hasOwn[block] != 0; }
  OwnDensity own(std::size_t block) const { return {*this, block}; }
  /// Density that a block draws from, per nm by cell.
  spectral::DomainSamples density(std::size_t block) const;
  /// Learnt share of each bin in a block's w F, smoothed; whether or not it is drawn from.
  std::array<double, kBins> histogram(std::size_t block) const { return smoothed(block); }

 private:
  static constexpr float kLargest = 1e11F;
  static constexpr float kUnits = 65536.0F;  ///< running sums of a block's bins are whole numbers of 1/65536

  static constexpr int kBands = 5;
  using Bins = std::array<double, kBins>;
  using BinChannels = Eigen::Matrix<double, kBins, Eigen::Dynamic>;
  using Bands = std::array<float, kBands>;  ///< of the spectrum, four bins each
  static std::size_t binOf(std::size_t cell) { return std::min(cell / kCellsABin, std::size_t{kBins - 1}); }
  std::size_t blockAt(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(m_width) + static_cast<std::size_t>(x);
  }
  spectral::DomainSamples learntSpectrum() const;
  void shareOut(const spectral::DomainSamples& learnt);
  void sumBands();
  bool isUnlikePicture(std::size_t block) const;
  Bins smoothed(std::size_t block) const;
  void buildBlock(std::size_t block);

  int m_side;    ///< of a block, pixels
  int m_width;   ///< blocks
  int m_height;  ///< blocks
  int m_lanes;
  spectral::DomainSamples m_expected;
  Channels m_channels;      ///< each one's share of w
  BinChannels m_binShares;  ///< mean share of w in a bin
  WavelengthTable m_picture;
  std::array<float, kBins + 1> m_pictureBelow{};  ///< the picture's distribution function at the edges of bins
  std::vector<float> m_learnt;                    ///< [block][bin]
  Spectrum m_spectrum;
  Bins m_learntByPicture{};            ///< share of each bin, a little of all
  std::vector<Bands> m_bands;          ///< [block], sum over 3 x 3 blocks
  std::vector<std::uint16_t> m_below;  ///< [block][bin], density's integral below the bin
  std::vector<std::uint8_t> m_hasOwn;  ///< [block]
  bool m_isUniform = false;
  bool m_isReady = false;
  std::mutex m_mutex;
};

}  // namespace metamer::spectral_ref
