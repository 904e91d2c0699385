// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
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
  static ExactSum of(double term) {
    // From the bits of the number, mantissa times 2^(exponent - 1075): guiding adds one for each lane of a path.
    constexpr int kMantissaBits = 52;
    constexpr int kNoShift = 1075 - 64;
    const auto bits = std::bit_cast<std::uint64_t>(term);
    const auto exponent = static_cast<int>(bits >> kMantissaBits) & 0x7ff;
    const std::uint64_t mantissa =
        (bits & ((std::uint64_t{1} << kMantissaBits) - 1)) | (std::uint64_t{1} << kMantissaBits);
    const int shift = exponent - kNoShift;
    ExactSum size;
    if (shift > 0) {
      size = {mantissa << shift, static_cast<std::int64_t>(mantissa >> (64 - shift))};
    } else if (shift > -64) {
      size.fraction = mantissa >> -shift;
    }
    return std::signbit(term) ? -size : size;
  }
  void add(double term) { add(of(term)); }
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
