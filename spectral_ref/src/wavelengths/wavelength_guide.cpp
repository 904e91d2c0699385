// SPDX-License-Identifier: Apache-2.0
#include "wavelengths/wavelength_guide.h"

#include <tbb/parallel_for.h>

namespace metamer::spectral_ref {
namespace {

constexpr int kRadius = 4;         ///< blocks, of the smoothing
constexpr float kLikeness = 0.3F;  ///< relative difference of two tints at which their weight has fallen to 0.6
/// Half width in cells of what a cell's expected luminance is scaled to.
constexpr int kScaleCells = 10;
/// Paths in a cell that count as much as what was expected there: their mean is then known to a hundredth, and the
/// density is smoother than what it divides.
constexpr double kExpectedPaths = 1e4;
/// Samples a pixel whose noise is judged: as many as each replicate of a picture of 64 samples has.
constexpr int kJudged = 16;
/// Relative variance of that many samples with uniform lanes up to which wavelengths stay uniform: other noise is
/// larger then, and reflectances may be less smooth in a density drawn from than in wavelength.
constexpr double kLittleVariance = 1.5e-4;
/// Relative variance of a block's light drawn from the picture's density from which the block gets its own: a quarter
/// of the samples or less then serve it. Nearer ones are better off with the picture's smooth density: the steps
/// between bins cost stratified samples more than a slope does.
constexpr double kUnlike = 8.0;
/// The same by bands, which show less of it, from which histograms are compared at all.
constexpr float kUnlikeBands = 1.0F;

/// Relative variance of lanes evenly spaced over the spectrum, one set from each of kJudged equal strata.
double varianceWithUniformLanes(const spectral::DomainSamples& worth, int lanes) {
  constexpr int kPlaces = 32;  // in a stratum
  const int strata = kJudged * lanes;
  double variance = 0;
  for (int stratum = 0; stratum < strata; ++stratum) {
    double sum = 0;
    double squares = 0;
    for (int place = 0; place < kPlaces; ++place) {
      const double u = (stratum + (place + 0.5) / kPlaces) / strata;
      const double value = worth[static_cast<int>(u * kCells)];
      sum += value / kPlaces;
      squares += value * value / kPlaces;
    }
    variance += squares - sum * sum;
  }
  const double mean = worth.mean() * strata;
  return mean > 0 ? variance / (mean * mean) : 0.0;
}

/// Gives each channel as much of an importance as any other has, spread as it is there.
/// @param shares  of each channel in what the importance counts, a row an element; no columns: nothing changes
/// @return  with the same sum
template <typename Importance, typename Shares>
Importance balanced(const Importance& importance, const Shares& shares) {
  Importance result = Importance::Zero();
  Eigen::Index lit = 0;
  for (Eigen::Index c = 0; c < shares.cols(); ++c) {
    const Importance part = importance.cwiseProduct(shares.col(c));
    if (const double sum = part.sum(); sum > 0) {
      result += part / sum;
      ++lit;
    }
  }
  return lit > 0 ? Importance(result * (importance.sum() / static_cast<double>(lit))) : importance;
}

bool isEven(const spectral::DomainSamples& worth, int lanes) {
  return varianceWithUniformLanes(worth, lanes) < kLittleVariance;
}

/// Side of a block, pixels: in large pictures as many as memory asks for.
int sideFor(int width, int height, bool isEvenLight) {
  constexpr double kMostBlocks = 1 << 22;
  int side = isEvenLight ? 2 : 1;
  while (side < 8 && static_cast<double>(width) * height > kMostBlocks * side * side) {
    side *= 2;
  }
  return side;
}

}  // namespace

WavelengthGuide::WavelengthGuide(int width, int height, int lanes, const spectral::DomainSamples& expected,
                                 const Channels& channels)
    : m_side(sideFor(width, height, isEven(expected, lanes))),
      m_width((width + m_side - 1) / m_side),
      m_height((height + m_side - 1) / m_side),
      m_lanes(lanes),
      m_expected(expected),
      m_channels(channels),
      m_picture(expected),
      m_learnt(static_cast<std::size_t>(m_width) * static_cast<std::size_t>(m_height) * kBins),
      m_hasOwn(m_learnt.size() / kBins) {
  for (Eigen::Index cell = 0; cell < kCells; ++cell) {
    if (const double worth = m_channels.row(cell).sum(); worth > 0) {
      m_channels.row(cell) /= worth;
    }
  }
}

void WavelengthGuide::add(const Spectrum& spectrum) {
  const std::lock_guard lock(m_mutex);
  for (std::size_t i = 0; i < kCells; ++i) {
    m_spectrum.worth[i].add(spectrum.worth[i]);
    m_spectrum.paths[i] += spectrum.paths[i];
  }
}

spectral::DomainSamples WavelengthGuide::learntSpectrum() const {
  spectral::DomainSamples learnt = spectral::DomainSamples::Zero();
  for (int cell = 0; cell < kCells; ++cell) {
    learnt[cell] = m_spectrum.worth[static_cast<std::size_t>(cell)].value();
  }
  // Where few paths have come by, the shape that was expected, scaled to what came by around.
  spectral::DomainSamples mixed;
  for (int cell = 0; cell < kCells; ++cell) {
    const int first = std::max(cell - kScaleCells, 0);
    const int count = std::min(cell + kScaleCells, kCells - 1) - first + 1;
    const double around = m_expected.segment(first, count).sum();
    const double scaled = around > 0 ? m_expected[cell] * learnt.segment(first, count).sum() / around : learnt[cell];
    const auto paths = static_cast<double>(m_spectrum.paths[static_cast<std::size_t>(cell)]);
    mixed[cell] = (paths * learnt[cell] + kExpectedPaths * scaled) / (paths + kExpectedPaths);
  }
  return mixed;
}

/// What the channels have of each bin, cells counting by what the whole picture has in them.
void WavelengthGuide::shareOut(const spectral::DomainSamples& learnt) {
  m_binShares = BinChannels::Zero(kBins, m_channels.cols());
  Eigen::Matrix<double, kBins, 1> sums = Eigen::Matrix<double, kBins, 1>::Zero();
  for (Eigen::Index cell = 0; cell < kCells; ++cell) {
    const auto bin = static_cast<Eigen::Index>(binOf(static_cast<std::size_t>(cell)));
    m_binShares.row(bin) += learnt[cell] * m_channels.row(cell);
    sums[bin] += learnt[cell];
  }
  for (Eigen::Index bin = 0; bin < kBins; ++bin) {
    if (sums[bin] > 0) {
      m_binShares.row(bin) /= sums[bin];
    }
  }
}

void WavelengthGuide::sumBands() {
  constexpr std::size_t kBinsABand = kBins / kBands;
  m_bands.assign(m_hasOwn.size(), {});
  tbb::parallel_for(0, m_height, [&](int y) {
    // Of three rows each column's, then of three columns.
    std::vector<Bands> columns(static_cast<std::size_t>(m_width));
    for (int row = std::max(0, y - 1); row <= std::min(m_height - 1, y + 1); ++row) {
      for (std::size_t x = 0; x < columns.size(); ++x) {
        const float* bins = m_learnt.data() + (blockAt(0, row) + x) * kBins;
        for (std::size_t bin = 0; bin < kBins; ++bin) {
          columns[x][bin / kBinsABand] += bins[bin];
        }
      }
    }
    for (int x = 0; x < m_width; ++x) {
      Bands& bands = m_bands[blockAt(x, y)];
      for (int column = std::max(0, x - 1); column <= std::min(m_width - 1, x + 1); ++column) {
        for (std::size_t band = 0; band < kBands; ++band) {
          bands[band] += columns[static_cast<std::size_t>(column)][band];
        }
      }
    }
  });
}

bool WavelengthGuide::isUnlikePicture(std::size_t block) const {
  const Bands& bands = m_bands[block];
  float sum = 0;
  for (const float band : bands) {
    sum += band;
  }
  float distance = -1.0F;  // sum of (a - b)^2 / b of two densities: that of a^2 / b, less 1
  for (std::size_t band = 0; band < kBands; ++band) {
    double picture = 0;
    for (std::size_t bin = band * kBins / kBands; bin < (band + 1) * kBins / kBands; ++bin) {
      picture += m_learntByPicture[bin];
    }
    const float share = bands[band] / sum;
    distance += share * share / static_cast<float>(picture);
  }
  return sum > 0.0F && distance > kUnlikeBands;
}

WavelengthGuide::Bins WavelengthGuide::smoothed(std::size_t block) const {
  const int x = static_cast<int>(block % static_cast<std::size_t>(m_width));
  const int y = static_cast<int>(block / static_cast<std::size_t>(m_width));
  // Once built the sums are no longer kept: they are worked out anew for the few blocks that are asked about.
  const auto bandsOf = [&](std::size_t center) {
    if (!m_bands.empty()) {
      return m_bands[center];
    }
    Bands result{};
    const int column = static_cast<int>(center % static_cast<std::size_t>(m_width));
    const int row = static_cast<int>(center / static_cast<std::size_t>(m_width));
    for (int v = std::max(0, row - 1); v <= std::min(m_height - 1, row + 1); ++v) {
      for (int u = std::max(0, column - 1); u <= std::min(m_width - 1, column + 1); ++u) {
        for (std::size_t bin = 0; bin < kBins; ++bin) {
          result[bin * kBands / kBins] += m_learnt[blockAt(u, v) * kBins + bin];
        }
      }
    }
    return result;
  };
  const Bands bands = bandsOf(block);
  Bins bins{};
  double sum = 0;
  for (int row = std::max(0, y - kRadius); row <= std::min(m_height - 1, y + kRadius); ++row) {
    for (int column = std::max(0, x - kRadius); column <= std::min(m_width - 1, x + kRadius); ++column) {
      const std::size_t other = blockAt(column, row);
      const Bands otherBands = bandsOf(other);
      float difference = 0;
      float size = 0;
      for (std::size_t band = 0; band < kBands; ++band) {
        const float a = bands[band];
        const float b = otherBands[band];
        difference += (a - b) * (a - b);
        size += 0.25F * (a + b) * (a + b);
      }
      if (!(size > 0.0F)) {
        continue;
      }
      const auto distance = static_cast<float>((column - x) * (column - x) + (row - y) * (row - y));
      const auto weight = static_cast<double>(
          std::exp(-0.5F * difference / (kLikeness * kLikeness * size) - 2.0F * distance / (kRadius * kRadius)));
      for (std::size_t bin = 0; bin < kBins; ++bin) {
        const double learnt = weight * static_cast<double>(m_learnt[other * kBins + bin]);
        bins[bin] += learnt;
        sum += learnt;
      }
    }
  }
  for (std::size_t bin = 0; bin < kBins; ++bin) {
    bins[bin] = sum > 0 ? bins[bin] / sum : m_learntByPicture[bin];
  }
  return bins;
}

void WavelengthGuide::buildBlock(std::size_t block) {
  if (!isUnlikePicture(block)) {
    return;
  }
  const Bins learnt = smoothed(block);
  const Eigen::Matrix<double, kBins, 1> drawn = balanced(Eigen::Matrix<double, kBins, 1>(learnt.data()), m_binShares);
  double distance = -1.0;
  double below = 0;
  for (std::size_t bin = 0; bin < kBins; ++bin) {
    distance += learnt[bin] * learnt[bin] / m_learntByPicture[bin];
    m_below[block * kBins + bin] = static_cast<std::uint16_t>(std::floor(below * static_cast<double>(kUnits)));
    const auto share = static_cast<double>(kPictureShare);
    below += share * static_cast<double>(m_pictureBelow[bin + 1] - m_pictureBelow[bin]) +
             (1.0 - share) * drawn[static_cast<Eigen::Index>(bin)];
  }
  m_hasOwn[block] = distance > kUnlike ? 1 : 0;
}

void WavelengthGuide::build() {
  const spectral::DomainSamples learnt = learntSpectrum();
  m_isUniform = isEven(learnt, m_lanes);
  const WavelengthTable table(learnt);
  m_picture = WavelengthTable(m_isUniform ? spectral::DomainSamples::Zero().eval() : balanced(learnt, m_channels));
  shareOut(learnt);
  for (std::size_t bin = 0; bin < kBins; ++bin) {
    const auto first = static_cast<std::int32_t>(bin) * kCellsABin;
    const std::int32_t end = bin + 1 < kBins ? first + kCellsABin : kCells;
    m_learntByPicture[bin] = static_cast<double>(table.below(end)) - static_cast<double>(table.below(first));
    m_pictureBelow[bin + 1] = m_picture.below(end);
  }
  m_below.resize(m_learnt.size());
  sumBands();
  tbb::parallel_for(std::size_t{0}, m_hasOwn.size(), [&](std::size_t block) { buildBlock(block); });
  std::vector<Bands>().swap(m_bands);
  m_isReady = true;
}

spectral::DomainSamples WavelengthGuide::density(std::size_t block) const {
  spectral::DomainSamples samples;
  for (std::int32_t cell = 0; cell < kCells; ++cell) {
    samples[cell] = static_cast<double>(hasOwn(block) ? own(block).density(cell) : m_picture.density(cell));
  }
  return samples;
}

}  // namespace metamer::spectral_ref
