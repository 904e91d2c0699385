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

constexpr std::size_t kBlock = static_cast<std::size_t>(WeightedSums::kBlock);
using Double = hn::CappedTag<double, kBlock / 4>;
using V = hn::VFromD<Double>;

/// Sums of one block's bands for each set of weights, kBlock numbers a set.
/// @tparam kTogether  vectors of bands at a time, for each set: their sums do not wait for one another
/// @param weights     count numbers a set
template <std::size_t kSets, std::size_t kTogether>
void sumBlock(const double* block, const double* weights, std::size_t count, double* sums) {
  const Double d;
  const std::size_t lanes = hn::Lanes(d);
  for (std::size_t band = 0; band < kBlock; band += kTogether * lanes) {
    std::array<std::array<V, kTogether>, kSets> sum;
    for (auto& ofSet : sum) {
      ofSet.fill(hn::Zero(d));
    }
    const double* row = block + band;
    for (std::size_t i = 0; i < count; ++i, row += kBlock) {
      std::array<V, kSets> weight;
      for (std::size_t set = 0; set < kSets; ++set) {
        weight[set] = hn::Set(d, weights[set * count + i]);
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
        hn::StoreU(sum[set][k], d, sums + set * kBlock + band + k * lanes);
      }
    }
  }
}

void sumBlockOnce(const double* block, const double* weights, std::size_t count, double* sums) {
  sumBlock<1, 4>(block, weights, count, sums);
}
void sumBlockThrice(const double* block, const double* weights, std::size_t count, double* sums) {
  sumBlock<3, 2>(block, weights, count, sums);
}

}  // namespace HWY_NAMESPACE
}  // namespace metamer::sip
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace metamer::sip {

namespace {

using SumBlock = void(const double*, const double*, std::size_t, double*);

}  // namespace

WeightedSums::WeightedSums(const Eigen::MatrixXd& spectra) : m_bandCount(spectra.rows()), m_count(spectra.cols()) {
  for (Eigen::Index first = 0; first < m_bandCount; first += kBlock) {
    const Eigen::Index bands = std::min(kBlock, m_bandCount - first);
    for (Eigen::Index i = 0; i < m_count; ++i) {
      const Eigen::VectorXd part = spectra.col(i).segment(first, bands);
      m_blocks.insert(m_blocks.end(), part.begin(), part.end());
      m_blocks.insert(m_blocks.end(), static_cast<std::size_t>(kBlock - bands), 0.0);
    }
  }
}

Eigen::MatrixXd WeightedSums::of(const Eigen::ArrayXXd& weights) const {
  assert(weights.rows() == m_count && (weights.cols() == 1 || weights.cols() == 3));
  const auto count = static_cast<std::size_t>(m_count);
  SumBlock* const sumBlock = weights.cols() == 1 ? METAMER_CHOOSE_KERNEL(SumBlock, sumBlockOnce)
                                                 : METAMER_CHOOSE_KERNEL(SumBlock, sumBlockThrice);
  Eigen::MatrixXd sums(m_bandCount, weights.cols());
  Eigen::Matrix<double, kBlock, Eigen::Dynamic, 0, kBlock, 3> part(kBlock, weights.cols());
  const double* block = m_blocks.data();
  for (Eigen::Index first = 0; first < m_bandCount; first += kBlock, block += kBlock * m_count) {
    const Eigen::Index bands = std::min(kBlock, m_bandCount - first);
    sumBlock(block, weights.data(), count, part.data());
    sums.middleRows(first, bands) = part.topRows(bands);
  }
  return sums;
}

}  // namespace metamer::sip
#endif
