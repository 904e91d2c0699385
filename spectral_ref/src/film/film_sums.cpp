// SPDX-License-Identifier: Apache-2.0
#include "metamer/spectral_ref/film_sums.h"

#include <algorithm>
#include <cassert>

namespace metamer::spectral_ref {
namespace {

constexpr auto kSegmentPixels = static_cast<std::size_t>(FilmSums::kSegment);

/// Of carries that are there or not.
bool areAllZero(const std::vector<std::int64_t>& carries) {
  return std::all_of(carries.begin(), carries.end(), [](std::int64_t count) { return count == 0; });
}

}  // namespace

FilmSums::FilmSums(int width, int height, std::size_t channels, int unitExponent)
    : m_width(static_cast<std::size_t>(width)),
      m_segmentsARow((m_width + kSegmentPixels - 1) / kSegmentPixels),
      m_channels(channels),
      m_unitsInOne(std::ldexp(1.0, -unitExponent)),
      m_wholeUnit(std::ldexp(1.0, unitExponent + 64)),
      m_lows(m_width * static_cast<std::size_t>(height) * channels),
      m_carries(m_segmentsARow * static_cast<std::size_t>(height)) {}

FilmSums::CarryPlace FilmSums::carryPlace(std::size_t place) const {
  const std::size_t pixel = place / m_channels;
  const std::size_t x = pixel % m_width;
  return {pixel / m_width * m_segmentsARow + x / kSegmentPixels, x % kSegmentPixels * m_channels + place % m_channels};
}

void FilmSums::carry(std::size_t place, std::int64_t count) {
  const auto [segment, index] = carryPlace(place);
  std::vector<std::int64_t>& carries = m_carries[segment];
  if (carries.empty()) {
    carries.resize(sumsASegment());
  }
  carries[index] += count;
}

/// A term that does not fit 64 bits: the whole number of 2^64 nearest to it, and the rest.
void FilmSums::addMany(std::size_t place, double units) {
  const double count = std::floor(units * 0x1p-64 + 0.5);
  carry(place, static_cast<std::int64_t>(count));
  // Exact: the doubles of this size are whole numbers. Within +-2^63, whose upper end is one too many.
  const double rest = units - count * 0x1p64;
  if (rest < 0x1p63) {
    addUnits(place, static_cast<std::int64_t>(rest));
  } else {
    carry(place, 1);
    addUnits(place, static_cast<std::int64_t>(rest - 0x1p64));
  }
}

void FilmSums::add(const FilmSums& other) {
  assert(other.m_lows.size() == m_lows.size() && other.m_unitsInOne == m_unitsInOne);
  for (std::size_t place = 0; place < m_lows.size(); ++place) {
    addUnits(place, other.m_lows[place]);
  }
  for (std::size_t segment = 0; segment < m_carries.size(); ++segment) {
    const std::vector<std::int64_t>& from = other.m_carries[segment];
    m_carries[segment].resize(std::max(m_carries[segment].size(), from.size()));
    for (std::size_t i = 0; i < from.size(); ++i) {
      m_carries[segment][i] += from[i];
    }
  }
}

ExactSum FilmSums::sum(std::size_t pixel, std::size_t channel) const {
  const std::size_t place = pixel * m_channels + channel;
  const std::int64_t low = m_lows[place];
  const auto [segment, index] = carryPlace(place);
  const std::vector<std::int64_t>& carries = m_carries[segment];
  return {static_cast<std::uint64_t>(low), (carries.empty() ? 0 : carries[index]) - (low < 0 ? 1 : 0)};
}

void FilmSums::set(std::size_t pixel, std::size_t channel, const ExactSum& sum) {
  const std::size_t place = pixel * m_channels + channel;
  const auto low = static_cast<std::int64_t>(sum.fraction);
  m_lows[place] = low;
  const std::int64_t count = sum.whole + (low < 0 ? 1 : 0);
  const auto [segment, index] = carryPlace(place);
  if (!m_carries[segment].empty()) {
    m_carries[segment][index] = count;
  } else if (count != 0) {
    carry(place, count);
  }
}

bool FilmSums::operator==(const FilmSums& other) const {
  if (m_channels != other.m_channels || m_width != other.m_width || m_unitsInOne != other.m_unitsInOne ||
      m_lows != other.m_lows) {
    return false;
  }
  for (std::size_t segment = 0; segment < m_carries.size(); ++segment) {
    const auto& own = m_carries[segment];
    const auto& others = other.m_carries[segment];
    // Carries that cancel have left room behind.
    if (own.size() == others.size() ? own != others : !areAllZero(own) || !areAllZero(others)) {
      return false;
    }
  }
  return true;
}

}  // namespace metamer::spectral_ref
