// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "metamer/spectral_ref/exact_sum.h"

namespace metamer::spectral_ref {

/// The sums that a film's pixels gather, several channels each: whole numbers of a unit, so that neither the order nor
/// the grouping of terms matters.
///
/// A sum takes 64 bits. One that outgrows them gets 64 more, for its carries, and its neighbours with it: what is kept
/// follows from the sums alone, and nothing is lost.
class FilmSums {
 public:
  /// Pixels side by side in a row, from the left, that get room for carries together.
  static constexpr int kSegment = 16;

  /// @param unitExponent  the unit is 2^unitExponent; a term is rounded to the nearest whole number of it
  FilmSums(int width, int height, std::size_t channels, int unitExponent);

  std::size_t channels() const { return m_channels; }

  /// Adds a term to a sum. Not two threads in one segment at a time.
  /// @param term  within +-2^116 units, so that billions of them fit; the caller sees to that
  void add(std::size_t pixel, std::size_t channel, double term) {
    const double units = term * m_unitsInOne;
    const std::size_t place = pixel * m_channels + channel;
    if (std::abs(units) < kMostAtOnce) {
      addUnits(place, std::llrint(units));
    } else {
      addMany(place, units);
    }
  }
  /// Adds whole units, as many as terms came to that were rounded each.
  void addUnits(std::size_t pixel, std::size_t channel, std::int64_t units) {
    addUnits(pixel * m_channels + channel, units);
  }
  /// What a term is multiplied with: a power of two.
  double unitsInOne() const { return m_unitsInOne; }
  /// Adds all sums of another film of the same size, channels and unit.
  void add(const FilmSums& other);

  double value(std::size_t pixel, std::size_t channel) const { return sum(pixel, channel).value() * m_wholeUnit; }
  /// A sum as 128 bits: a fraction of 1 stands for one unit.
  ExactSum sum(std::size_t pixel, std::size_t channel) const;
  void set(std::size_t pixel, std::size_t channel, const ExactSum& sum);

  /// What a checkpoint keeps: the lower 64 bits of every sum, with a sign, row by row ...
  std::vector<std::int64_t>& lows() { return m_lows; }
  const std::vector<std::int64_t>& lows() const { return m_lows; }
  /// ... and the carries of every segment, by pixel and channel; empty: none.
  std::vector<std::vector<std::int64_t>>& carries() { return m_carries; }
  const std::vector<std::vector<std::int64_t>>& carries() const { return m_carries; }
  std::size_t sumsASegment() const { return static_cast<std::size_t>(kSegment) * m_channels; }

  bool operator==(const FilmSums& other) const;

 private:
  static constexpr double kMostAtOnce = 0x1p62;

  void addUnits(std::size_t place, std::int64_t units) {
    std::int64_t& low = m_lows[place];
    const auto sum = static_cast<std::int64_t>(static_cast<std::uint64_t>(low) + static_cast<std::uint64_t>(units));
    // Neither number has the sum's sign.
    if (((low ^ sum) & (units ^ sum)) < 0) {
      carry(place, units < 0 ? -1 : 1);
    }
    low = sum;
  }
  void addMany(std::size_t place, double units);
  void carry(std::size_t place, std::int64_t count);
  struct CarryPlace {
    std::size_t segment;
    std::size_t index;
  };
  CarryPlace carryPlace(std::size_t place) const;

  std::size_t m_width;
  std::size_t m_segmentsARow;
  std::size_t m_channels;
  double m_unitsInOne;
  double m_wholeUnit;  ///< 2^64 units
  std::vector<std::int64_t> m_lows;
  std::vector<std::vector<std::int64_t>> m_carries;
};

}  // namespace metamer::spectral_ref
