// SPDX-License-Identifier: Apache-2.0
#include "wavelength_guide.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "wavelength_sampling.h"

namespace metamer::spectral_ref {
namespace {

constexpr int kRadius = 4;         ///< pixels, of the smoothing
constexpr double kLikeness = 0.3;  ///< relative difference of two histograms at which their weight has fallen to 0.6
/// Part of the picture's mean histogram in every pixel: what a dark pixel with nothing learnt falls back on.
constexpr double kPictureShare = 0.02;
/// Relative variance by wavelength of one path with uniform lanes below which a pixel stays uniform: a learnt density
/// is not exact enough to do better.
constexpr double kLittleVariance = 0.2;

}  // namespace

WavelengthGuide::WavelengthGuide(int width, int height, int lanes)
    : m_width(width),
      m_height(height),
      m_lanes(lanes),
      m_learnt(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * kBins),
      m_fine(kCells),
      m_bins(m_learnt.size()),
      m_isUniform(m_learnt.size() / kBins),
      m_within(kCells),
      m_belowCell(kCells + kBins) {}

void WavelengthGuide::addFine(const std::vector<ExactSum>& fine) {
  const std::lock_guard lock(m_mutex);
  for (std::size_t i = 0; i < m_fine.size(); ++i) {
    m_fine[i].add(fine[i]);
  }
}

void WavelengthGuide::smoothed(int x, int y, std::array<double, kBins>& bins) const {
  const auto at = [&](int column, int row) {
    return m_learnt.data() +
           (static_cast<std::size_t>(row) * static_cast<std::size_t>(m_width) + static_cast<std::size_t>(column)) *
               kBins;
  };
  const float* own = at(x, y);
  bins.fill(0.0);
  for (int row = std::max(0, y - kRadius); row <= std::min(m_height - 1, y + kRadius); ++row) {
    for (int column = std::max(0, x - kRadius); column <= std::min(m_width - 1, x + kRadius); ++column) {
      const float* other = at(column, row);
      // Thirds of the spectrum are compared: single bins are too noisy after a few samples.
      double difference = 0;
      double size = 0;
      for (int third = 0; third < 3; ++third) {
        double a = 0;
        double b = 0;
        for (int bin = third * kBins / 3; bin < (third + 1) * kBins / 3; ++bin) {
          a += static_cast<double>(own[bin]);
          b += static_cast<double>(other[bin]);
        }
        difference += (a - b) * (a - b);
        size += 0.25 * (a + b) * (a + b);
      }
      if (!(size > 0)) {
        continue;
      }
      const double distance = (column - x) * (column - x) + (row - y) * (row - y);
      const double weight =
          std::exp(-0.5 * difference / (kLikeness * kLikeness * size) - 0.5 * distance / (0.25 * kRadius * kRadius));
      for (std::size_t bin = 0; bin < kBins; ++bin) {
        bins[bin] += weight * static_cast<double>(other[bin]);
      }
    }
  }
}

double WavelengthGuide::uniformVariance(const std::array<double, kBins>& bins) const {
  // The estimate of one path by the place of its hero: a sum over evenly spaced cells, with its mean 1.
  double squares = 0;
  const double spacing = static_cast<double>(kCells) / m_lanes;
  const int offsets = static_cast<int>(spacing);
  for (int offset = 0; offset < offsets; ++offset) {
    double sum = 0;
    for (int k = 0; k < m_lanes; ++k) {
      const int cell = std::min(static_cast<int>(offset + k * spacing), kCells - 1);
      sum += bins[binOf(cell)] * static_cast<double>(m_within[static_cast<std::size_t>(cell)]);
    }
    squares += (spacing * sum - 1.0) * (spacing * sum - 1.0);
  }
  return squares / offsets;
}

void WavelengthGuide::build() {
  std::array<double, kBins> picture{};
  double total = 0;
  for (int bin = 0; bin < kBins; ++bin) {
    const int count = endCell(bin) - firstCell(bin);
    double sum = 0;
    for (int cell = firstCell(bin); cell < endCell(bin); ++cell) {
      sum += m_fine[static_cast<std::size_t>(cell)].value();
    }
    double below = 0;
    for (int cell = firstCell(bin); cell < endCell(bin); ++cell) {
      const double share = sum > 0 ? m_fine[static_cast<std::size_t>(cell)].value() / sum : 1.0 / count;
      m_belowCell[static_cast<std::size_t>(cell + bin)] = static_cast<float>(below);
      m_within[static_cast<std::size_t>(cell)] = static_cast<float>(share);
      below += share;
    }
    m_belowCell[static_cast<std::size_t>(endCell(bin) + bin)] = 1.0F;
    picture[static_cast<std::size_t>(bin)] = sum;
    total += sum;
  }
  tbb::parallel_for(0, m_height, [&](int y) {
    std::array<double, kBins> bins{};
    for (int x = 0; x < m_width; ++x) {
      smoothed(x, y, bins);
      double sum = 0;
      for (const double bin : bins) {
        sum += bin;
      }
      for (std::size_t bin = 0; bin < kBins; ++bin) {
        const double mean = total > 0 ? picture[bin] / total : 1.0 / kBins;
        bins[bin] = sum > 0 ? (1.0 - kPictureShare) * bins[bin] / sum + kPictureShare * mean : mean;
      }
      m_isUniform[static_cast<std::size_t>(y) * static_cast<std::size_t>(m_width) + static_cast<std::size_t>(x)] =
          uniformVariance(bins) < kLittleVariance ? 1 : 0;
      // Running sums in whole units, the uniform share in; none below what that share alone comes to.
      std::uint16_t* units =
          m_bins.data() +
          (static_cast<std::size_t>(y) * static_cast<std::size_t>(m_width) + static_cast<std::size_t>(x)) * kBins;
      double running = 0;
      for (int bin = 0; bin < kBins; ++bin) {
        const double uniform = static_cast<double>(firstCell(bin)) / kCells;
        const double defensive = static_cast<double>(kDefensive);
        units[bin] = static_cast<std::uint16_t>(
            std::floor(((1.0 - defensive) * running + defensive * uniform) * static_cast<double>(kUnits)));
        running += bins[static_cast<std::size_t>(bin)];
      }
    }
  });
  m_isReady = true;
}

float WavelengthGuide::Density::density(std::int32_t cell) const {
  if (m_isUniform) {
    return 1.0F / static_cast<float>(kCells);
  }
  const auto bin = static_cast<int>(binOf(cell));
  const float below = static_cast<float>(m_below[bin]) / kUnits;
  const float end = bin + 1 < kBins ? static_cast<float>(m_below[bin + 1]) / kUnits : 1.0F;
  const auto count = static_cast<float>(endCell(bin) - firstCell(bin));
  return (end - below - kUniformCell * count) * m_guide.m_within[static_cast<std::size_t>(cell)] + kUniformCell;
}

void WavelengthGuide::Density::sample(float u, float& nm, std::int32_t& cell, float& inverseDensity) const {
  if (m_isUniform) {
    UniformWavelengths().sample(u, nm, cell, inverseDensity);
    return;
  }
  // The bin: how many of the running sums lie at or below u.
  int bin = -1;
  for (int i = 0; i < kBins; ++i) {
    bin += static_cast<float>(m_below[i]) <= u * kUnits ? 1 : 0;
  }
  const float below = static_cast<float>(m_below[bin]) / kUnits;
  const float end = bin + 1 < kBins ? static_cast<float>(m_below[bin + 1]) / kUnits : 1.0F;
  const auto count = static_cast<float>(endCell(bin) - firstCell(bin));
  const float inBin = end - below - kUniformCell * count;
  // The cell within it: a binary search on its running sum.
  const float* shares = m_guide.m_belowCell.data() + firstCell(bin) + bin;
  const float rest = u - below;
  const auto upTo = [&](int i) { return inBin * shares[i] + kUniformCell * static_cast<float>(i); };
  int low = 0;
  int high = endCell(bin) - firstCell(bin);
  while (high - low > 1) {
    const int middle = (low + high) / 2;
    (upTo(middle) <= rest ? low : high) = middle;
  }
  cell = firstCell(bin) + low;
  const float density = inBin * m_guide.m_within[static_cast<std::size_t>(cell)] + kUniformCell;
  nm = kFirstEdgeNm + static_cast<float>(cell) + std::clamp((rest - upTo(low)) / density, 0.0F, 0x1.fffp-1F);
  inverseDensity = 1.0F / density;
}

void WavelengthGuide::save(StateWriter& writer) const {
  writer.put(m_isReady);
  writer.putAll(m_learnt);
  writer.putAll(m_fine);
  writer.putAll(m_bins);
  writer.putAll(m_isUniform);
  writer.putAll(m_within);
  writer.putAll(m_belowCell);
}

void WavelengthGuide::restore(StateReader& reader) {
  m_isReady = reader.get<bool>();
  reader.getAll(m_learnt);
  reader.getAll(m_fine);
  reader.getAll(m_bins);
  reader.getAll(m_isUniform);
  reader.getAll(m_within);
  reader.getAll(m_belowCell);
}

}  // namespace metamer::spectral_ref
