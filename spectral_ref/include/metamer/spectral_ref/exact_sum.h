// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>

namespace metamer::spectral_ref {

/// A sum that does not depend on the order of its terms: fixed point, 64 bits before and 64 after the binary point.
/// So sample ranges, tiles and threads may be added up in any grouping and give the same bits. A term loses what lies
/// below 2^-64 (5e-20).
struct ExactSum {
  std::uint64_t fraction = 0;
  std::int64_t whole = 0;

  /// @param term  within +-1e12, so that millions of them fit; the caller sees to that
  void add(double term) {
    constexpr double kScale = 18446744073709551616.0;  // 2^64
    // Through the absolute value: its whole part leaves a rest that a double holds exactly.
    const double size = std::abs(term);
    const double below = std::floor(size);
    const ExactSum positive{static_cast<std::uint64_t>((size - below) * kScale), static_cast<std::int64_t>(below)};
    add(term < 0 ? -positive : positive);
  }
  ExactSum operator-() const { return {0 - fraction, -whole - (fraction != 0 ? 1 : 0)}; }
  void add(const ExactSum& other) {
    fraction += other.fraction;
    whole += other.whole + (fraction < other.fraction ? 1 : 0);
  }
  double value() const {
    constexpr double kScale = 1.0 / 18446744073709551616.0;
    if (whole < 0) {
      return -(-*this).value();  // the two parts of a small negative sum would cancel
    }
    return static_cast<double>(whole) + static_cast<double>(fraction) * kScale;
  }
  bool operator==(const ExactSum&) const = default;
};

}  // namespace metamer::spectral_ref
