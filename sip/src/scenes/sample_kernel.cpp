// SPDX-License-Identifier: Apache-2.0
// Compiled once per instruction set by Highway and chosen at run time.
#include "scenes/sample_kernel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "scenes/sample_kernel.cpp"
#include <hwy/foreach_target.h>
// Highway's dispatch needs the target list first.
#include <hwy/highway.h>

#include <algorithm>

#include "vector/choose_kernel.h"
#include "vector/double_functions-inl.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::sip {
namespace HWY_NAMESPACE {

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

constexpr Eigen::Index kPadding = HWY_NAMESPACE::kMostDoubles;

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
