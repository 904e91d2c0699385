// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <cstring>

namespace metamer::sip {

/// a * b + c by way of double, where std::fma would be a slow call. The product is exact there, the sum rounded, and
/// the result rounded again: as if once, but where the sum lies half way between two numbers of float, or under its
/// normal ones; `isRoundedOnce` then becomes false.
inline float fusedInDouble(float a, float b, float c, bool& isRoundedOnce) {
  const double sum = static_cast<double>(a) * static_cast<double>(b) + static_cast<double>(c);
  std::uint64_t bits = 0;
  std::memcpy(&bits, &sum, sizeof bits);
  constexpr std::uint64_t kBelowFloat = (std::uint64_t{1} << 29) - 1;
  constexpr std::uint64_t kHalf = std::uint64_t{1} << 28;
  constexpr std::uint64_t kSize = ~(std::uint64_t{1} << 63);
  constexpr std::uint64_t kSmallestNormal = std::uint64_t{1023 - 126} << 52;
  const std::uint64_t size = bits & kSize;
  isRoundedOnce &= static_cast<int>((bits & kBelowFloat) != kHalf) & static_cast<int>(size - 1 >= kSmallestNormal - 1);
  return static_cast<float>(sum);
}

}  // namespace metamer::sip
