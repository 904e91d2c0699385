// SPDX-License-Identifier: Apache-2.0
// Compiled once per instruction set by Highway and chosen at run time.
#include "scenes/weighted_sums.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "scenes/weighted_sums.cpp"
#include <hwy/foreach_target.h>
// Highway's dispatch needs the target list first.
#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <cassert>

#include "vector/choose_kernel.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::sip {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

constexpr std::size_t kMostDoubles = static_cast<std::size_t>(WeightedSums::kPadding);
using Double = hn::CappedTag<double, kMostDoubles>;
using V = hn::VFromD<Double>;

/// Spectra that are added to all sets before the next: they stay in a processor's first cache meanwhile.
constexpr std::size_t kBlock = 64;
/// Sets that are summed at once.
constexpr std::size_t kMostSets = 3;

/// Spectra and weights as they lie in memory.
struct Sums {
  const double* spectra;  ///< a row a spectrum
  std::size_t bands;      ///< of a row, padded
  std::size_t count;      ///< of spectra
  const double* weights;
  std::size_t weightStride;  ///< from set to set
  double* sums;              ///< `bands` numbers a set
};

/// Adds to sums from a band on, with as many vectors of bands at a time as there are registers for: every spectrum is
/// then loaded once for all sets, and the sums do not wait for one another.
template <std::size_t kSets, std::size_t kTogether>
HWY_INLINE void sumFrom(const Sums& job, std::size_t band) {
  const Double d;
  const std::size_t lanes = hn::Lanes(d);
  for (; band + kTogether * lanes <= job.bands; band += kTogether * lanes) {
    std::array<std::array<V, kTogether>, kSets> sum;
    for (std::size_t set = 0; set < kSets; ++set) {
      for (std::size_t k = 0; k < kTogether; ++k) {
        sum[set][k] = hn::LoadU(d, job.sums + set * job.bands + band + k * lanes);
      }
    }
    const double* row = job.spectra + band;
    for (std::size_t i = 0; i < job.count; ++i, row += job.bands) {
      std::array<V, kSets> weight;
      for (std::size_t set = 0; set < kSets; ++set) {
        weight[set] = hn::Set(d, job.weights[set * job.weightStride + i]);
      }
      for (std::size_t k = 0; k < kTogether; ++k) {
        const V bands = hn::LoadU(d, row + k * lanes);
        for (std::size_t set = 0; set < kSets; ++set) {
          sum[set][k] = hn::Add(sum[set][k], hn::Mul(weight[set], bands));
        }
      }
    }
    for (std::size_t set = 0; set < kSets; ++set) {
      for (std::size_t k = 0; k < kTogether; ++k) {
        hn::StoreU(sum[set][k], d, job.sums + set * job.bands + band + k * lanes);
      }
    }
  }
  if constexpr (kTogether > 1) {
    sumFrom<kSets, kTogether - 1>(job, band);
  }
}

void sumSome(const Sums& job, std::size_t sets) {
  constexpr bool kHasManyRegisters = HWY_MAX_BYTES == 64;
  switch (sets) {
    case 1:
      return sumFrom<1, 11>(job, 0);
    case 2:
      return sumFrom < 2, kHasManyRegisters ? 11 : 6 > (job, 0);
    default:
      return sumFrom < 3, kHasManyRegisters ? 6 : 4 > (job, 0);
  }
}

/// @param sums  zeros
void sumSets(const double* spectra, std::size_t bands, std::size_t count, const double* weights,
             std::size_t weightStride, std::size_t sets, double* sums) {
  for (std::size_t first = 0; first < count; first += kBlock) {
    for (std::size_t set = 0; set < sets; set += kMostSets) {
      sumSome({spectra + first * bands, bands, std::min(kBlock, count - first), weights + set * weightStride + first,
               weightStride, sums + set * bands},
              std::min(kMostSets, sets - set));
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace metamer::sip
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace metamer::sip {

namespace {

using SumSets = void(const double*, std::size_t, std::size_t, const double*, std::size_t, std::size_t, double*);

}  // namespace

WeightedSums::WeightedSums(const Eigen::MatrixXd& spectra)
    : m_bandCount(spectra.rows()),
      m_spectra(Eigen::MatrixXd::Zero((spectra.rows() + kPadding - 1) / kPadding * kPadding, spectra.cols())) {
  m_spectra.topRows(m_bandCount) = spectra;
}

Eigen::MatrixXd WeightedSums::of(const Eigen::Ref<const Eigen::MatrixXd>& weights) const {
  assert(weights.rows() >= count());
  Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(m_spectra.rows(), weights.cols());
  METAMER_CHOOSE_KERNEL(SumSets, sumSets)
  (m_spectra.data(), static_cast<std::size_t>(m_spectra.rows()), static_cast<std::size_t>(count()), weights.data(),
   static_cast<std::size_t>(weights.outerStride()), static_cast<std::size_t>(weights.cols()), sums.data());
  return sums;
}

}  // namespace metamer::sip
#endif
