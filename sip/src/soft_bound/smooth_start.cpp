// SPDX-License-Identifier: Apache-2.0
// Compiled once per instruction set by Highway and chosen at run time.
#include "soft_bound/smooth_start.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "soft_bound/smooth_start.cpp"
#include <hwy/foreach_target.h>
// Highway's dispatch needs the target list first.
#include <hwy/highway.h>

#include "soft_bound/newton_lanes.h"
#include "vector/choose_kernel.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::sip {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Bands from `first` on, as many as vectors fill. @return the first that is left
template <class D>
HWY_INLINE int spectrumFrom(D d, int first, const SmoothStart& start, const double* c, const double* prior,
                            double* spectrum, double& least, double& most) {
  const int lanes = static_cast<int>(hn::Lanes(d));
  auto low = hn::Set(d, least);
  auto high = hn::Set(d, most);
  const double* const second = start.unclamped + start.bandCount;
  const double* const third = second + start.bandCount;
  int b = first;
  for (; b + lanes <= start.bandCount; b += lanes) {
    auto value = hn::Mul(hn::LoadU(d, start.unclamped + b), hn::Set(d, c[0]));
    value = hn::Add(value, hn::Mul(hn::LoadU(d, second + b), hn::Set(d, c[1])));
    value = hn::Add(value, hn::Mul(hn::LoadU(d, third + b), hn::Set(d, c[2])));
    if (prior != nullptr) {
      value = hn::Add(value, hn::LoadU(d, prior + b));
    }
    hn::StoreU(value, d, spectrum + b);
    low = hn::Min(low, value);
    high = hn::Max(high, hn::Abs(value));
  }
  least = hn::GetLane(hn::MinOfLanes(d, low));
  most = hn::GetLane(hn::MaxOfLanes(d, high));
  return b;
}

bool smoothStart(const SmoothStart& start, const double* tristimulus, const double* prior, double* spectrum) {
  double least = 0.0;
  double most = 0.0;
  const int rest = spectrumFrom(hn::CappedTag<double, 8>(), 0, start, tristimulus, prior, spectrum, least, most);
  spectrumFrom(hn::CappedTag<double, 1>(), rest, start, tristimulus, prior, spectrum, least, most);
  return least >= -kNothing * most;
}

}  // namespace HWY_NAMESPACE
}  // namespace metamer::sip
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace metamer::sip {

namespace {

using Start = bool(const SmoothStart&, const double*, const double*, double*);

}  // namespace

bool SmoothStart::operator()(const double* tristimulus, const double* prior, double* spectrum) const {
  return METAMER_CHOOSE_KERNEL(Start, smoothStart)(*this, tristimulus, prior, spectrum);
}

}  // namespace metamer::sip
#endif
