// SPDX-License-Identifier: Apache-2.0
// Functions of vectors of doubles, without fused operations: not every instruction set has them, and all give the same
// bits. Compiled once an instruction set, inside the file that includes it.
#if defined(METAMER_SIP_DOUBLE_FUNCTIONS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef METAMER_SIP_DOUBLE_FUNCTIONS_INL_H
#undef METAMER_SIP_DOUBLE_FUNCTIONS_INL_H
#else
#define METAMER_SIP_DOUBLE_FUNCTIONS_INL_H
#endif

#include <hwy/highway.h>

#include <array>
#include <cstdint>
#include <numbers>

HWY_BEFORE_NAMESPACE();
namespace metamer::sip {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

constexpr std::size_t kMostDoubles = 8;
using Double = hn::CappedTag<double, kMostDoubles>;
using Long = hn::RebindToSigned<Double>;
using V = hn::VFromD<Double>;

/// Adding this rounds to whole numbers, which then stand in the lowest bits.
constexpr double kRounding = 0x1.8p52;
constexpr int kExponentBias = 1023;
constexpr int kMantissaBits = 52;

/// Of the powers of x, the highest coefficient first.
template <std::size_t count>
HWY_INLINE V polynomial(V x, const std::array<double, count>& coefficients) {
  const Double d;
  V sum = hn::Set(d, coefficients[0]);
  for (std::size_t i = 1; i < count; ++i) {
    sum = hn::Add(hn::Mul(sum, x), hn::Set(d, coefficients[i]));
  }
  return sum;
}

/// exp(-t), 0 <= t, to two units of the last place.
HWY_INLINE V fade(V distance) {
  /// Behind this the exponential is nothing, and its exponent still a normal one.
  constexpr double kFarthest = 700.0;
  /// ln 2 in two parts, the first short enough for its multiples here to be exact (Cody and Waite).
  constexpr double kLn2High = 0x1.62e42fee00000p-1;
  constexpr double kLn2Low = 0x1.a39ef35793c76p-33;
  const Double d;
  const Long dl;
  const V t = hn::Min(distance, hn::Set(d, kFarthest));
  const V shifted = hn::Add(hn::Mul(t, hn::Set(d, -std::numbers::log2e)), hn::Set(d, kRounding));
  const V whole = hn::Sub(shifted, hn::Set(d, kRounding));
  const V high = hn::Add(t, hn::Mul(whole, hn::Set(d, kLn2High)));
  const V rest = hn::Sub(hn::Neg(high), hn::Mul(whole, hn::Set(d, kLn2Low)));
  // Taylor's series on |rest| <= ln 2 / 2.
  constexpr std::array<double, 13> kInverseFactorials = {1.0 / 479001600.0,
                                                         1.0 / 39916800.0,
                                                         1.0 / 3628800.0,
                                                         1.0 / 362880.0,
                                                         1.0 / 40320.0,
                                                         1.0 / 5040.0,
                                                         1.0 / 720.0,
                                                         1.0 / 120.0,
                                                         1.0 / 24.0,
                                                         1.0 / 6.0,
                                                         0.5,
                                                         1.0,
                                                         1.0};
  const auto exponent = hn::ShiftLeft<kMantissaBits>(
      hn::Add(hn::BitCast(dl, shifted), hn::Set(dl, static_cast<std::int64_t>(kExponentBias))));
  return hn::Mul(polynomial(rest, kInverseFactorials), hn::BitCast(d, exponent));
}

/// The cube root of a normal positive number, to a unit or two of the last place.
HWY_INLINE V cubeRoot(V x) {
  const Double d;
  const Long dl;
  // A third of the logarithm that the bits are, but for the lowest 20, near enough: the bits' upper part as a number.
  constexpr int kDropped = 20;
  constexpr double kWhole = 0x1p52;
  constexpr std::int64_t kMask = (std::int64_t{1} << kMantissaBits) - 1;
  constexpr double kTwoThirds = 2.0 / 3.0 * 1022.95 * 0x1p32;
  const auto upper = hn::ShiftRight<kDropped>(hn::BitCast(dl, x));
  const V asNumber = hn::Sub(hn::BitCast(d, hn::Or(upper, hn::BitCast(dl, hn::Set(d, kWhole)))), hn::Set(d, kWhole));
  const V third = hn::Add(hn::Mul(asNumber, hn::Set(d, 1.0 / 3.0)), hn::Set(d, kTwoThirds + kWhole));
  V root = hn::BitCast(d, hn::ShiftLeft<kDropped>(hn::And(hn::BitCast(dl, third), hn::Set(dl, kMask))));
  // Halley's method, from within 4 % to beyond the last place in three rounds.
  for (int round = 0; round < 3; ++round) {
    const V cube = hn::Mul(hn::Mul(root, root), root);
    root = hn::Sub(root, hn::Mul(root, hn::Div(hn::Sub(cube, x), hn::Add(hn::Add(cube, cube), x))));
  }
  return root;
}

}  // namespace HWY_NAMESPACE
}  // namespace metamer::sip
HWY_AFTER_NAMESPACE();

#endif
