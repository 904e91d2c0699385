// SPDX-License-Identifier: Apache-2.0
// Compiled once per instruction set by Highway and chosen at run time.
#include "scenes/sample_kernel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "scenes/sample_kernel.cpp"
#include <hwy/foreach_target.h>
// Highway's dispatch needs the target list first.
#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <numbers>

#include "vector/choose_kernel.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::sip {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

constexpr std::size_t kMostDoubles = 8;
using Double = hn::CappedTag<double, kMostDoubles>;
using Long = hn::RebindToSigned<Double>;
using V = hn::VFromD<Double>;

/// Behind this the exponential is nothing, and its exponent still a normal one.
constexpr double kFarthest = 700.0;
/// ln 2 in two parts, the first short enough for its multiples here to be exact (Cody and Waite).
constexpr double kLn2High = 0x1.62e42fee00000p-1;
constexpr double kLn2Low = 0x1.a39ef35793c76p-33;
/// Adding this rounds to whole numbers, which then stand in the lowest bits.
constexpr double kRounding = 0x1.8p52;
constexpr int kExponentBias = 1023;
constexpr int kMantissaBits = 52;

/// exp(-t), 0 <= t. No fused operations: not every instruction set has them.
HWY_INLINE V fade(V distance) {
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
  V power = hn::Set(d, kInverseFactorials[0]);
  for (std::size_t i = 1; i < kInverseFactorials.size(); ++i) {
    power = hn::Add(hn::Mul(power, rest), hn::Set(d, kInverseFactorials[i]));
  }
  const auto exponent = hn::ShiftLeft<kMantissaBits>(
      hn::Add(hn::BitCast(dl, shifted), hn::Set(dl, static_cast<std::int64_t>(kExponentBias))));
  return hn::Mul(power, hn::BitCast(d, exponent));
}

/// @param count   a multiple of kMostDoubles
/// @param kernel  count numbers, and where kSlopes, twice as many more
template <bool kSlopes>
void kernelAt(const double* x, const double* y, std::size_t count, const double* place, double* kernel) {
  const Double d;
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
    const V dx = hn::Sub(hn::LoadU(d, x + i), hn::Set(d, place[0]));
    const V dy = hn::Sub(hn::LoadU(d, y + i), hn::Set(d, place[1]));
    const V t = hn::Sqrt(hn::Add(hn::Mul(dx, dx), hn::Mul(dy, dy)));
    const V faded = fade(t);
    hn::StoreU(hn::Add(faded, hn::Mul(t, faded)), d, kernel + i);
    if constexpr (kSlopes) {
      hn::StoreU(hn::Mul(dx, faded), d, kernel + count + i);
      hn::StoreU(hn::Mul(dy, faded), d, kernel + 2 * count + i);
    }
  }
}

void valuesAt(const double* x, const double* y, std::size_t count, const double* place, double* kernel) {
  kernelAt<false>(x, y, count, place, kernel);
}
void valuesAndSlopesAt(const double* x, const double* y, std::size_t count, const double* place, double* kernel) {
  kernelAt<true>(x, y, count, place, kernel);
}

}  // namespace HWY_NAMESPACE
}  // namespace metamer::sip
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace metamer::sip {

namespace {

using KernelAt = void(const double*, const double*, std::size_t, const double*, double*);

constexpr Eigen::Index kPadding = 8;

}  // namespace

SampleKernel::SampleKernel(const Eigen::ArrayX2d& places) {
  const auto padded = static_cast<std::size_t>((places.rows() + kPadding - 1) / kPadding * kPadding);
  m_x.assign(places.col(0).begin(), places.col(0).end());
  m_y.assign(places.col(1).begin(), places.col(1).end());
  m_x.resize(padded);
  m_y.resize(padded);
}

Eigen::VectorXd SampleKernel::values(const Eigen::Vector2d& place) const {
  Eigen::VectorXd kernel(rows());
  values(place, kernel);
  return kernel;
}

void SampleKernel::values(const Eigen::Vector2d& place, Eigen::Ref<Eigen::VectorXd> kernel) const {
  METAMER_CHOOSE_KERNEL(KernelAt, valuesAt)(m_x.data(), m_y.data(), m_x.size(), place.data(), kernel.data());
}

Eigen::MatrixX3d SampleKernel::valuesAndSlopes(const Eigen::Vector2d& place) const {
  Eigen::MatrixX3d kernel(rows(), 3);
  METAMER_CHOOSE_KERNEL(KernelAt, valuesAndSlopesAt)
  (m_x.data(), m_y.data(), m_x.size(), place.data(), kernel.data());
  return kernel;
}

}  // namespace metamer::sip
#endif
