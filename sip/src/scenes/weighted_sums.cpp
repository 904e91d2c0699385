// SPDX-License-Identifier: Apache-2.0
// Compiled once per instruction set and chosen at run time (Highway).
#include "scenes/weighted_sums.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "scenes/weighted_sums.cpp"
#include <hwy/foreach_target.h>
// Highway's dispatch needs the target list first.
#include <hwy/highway.h>

#include <algorithm>
#include <array>

HWY_BEFORE_NAMESPACE();
namespace metamer::sip {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

constexpr std::size_t kBlock = WeightedSums::kBlock;
/// A wider vector than a block's quarter would leave no two sums to be taken side by side.
using Double = hn::CappedTag<double, kBlock / 4>;
using V = hn::VFromD<Double>;

/// sum[0 ... kBlock - 1] of one block, added to `sum`.
void addBlock(const double* block, const double* weights, std::size_t count, double* sum) {
  const Double d;
  const std::size_t lanes = hn::Lanes(d);
  // Four vectors at a time: their sums do not wait for one another.
  for (std::size_t band = 0; band < kBlock; band += 4 * lanes) {
    V first = hn::LoadU(d, sum + band);
    V second = hn::LoadU(d, sum + band + lanes);
    V third = hn::LoadU(d, sum + band + 2 * lanes);
    V fourth = hn::LoadU(d, sum + band + 3 * lanes);
    const double* row = block + band;
    for (std::size_t i = 0; i < count; ++i, row += kBlock) {
      const V weight = hn::Set(d, weights[i]);
      first = hn::Add(first, hn::Mul(weight, hn::LoadU(d, row)));
      second = hn::Add(second, hn::Mul(weight, hn::LoadU(d, row + lanes)));
      third = hn::Add(third, hn::Mul(weight, hn::LoadU(d, row + 2 * lanes)));
      fourth = hn::Add(fourth, hn::Mul(weight, hn::LoadU(d, row + 3 * lanes)));
    }
    hn::StoreU(first, d, sum + band);
    hn::StoreU(second, d, sum + band + lanes);
    hn::StoreU(third, d, sum + band + 2 * lanes);
    hn::StoreU(fourth, d, sum + band + 3 * lanes);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace metamer::sip
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace metamer::sip {

HWY_EXPORT(addBlock);

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

void WeightedSums::addTo(const double* weights, double* sum) const {
  const double* block = m_blocks.data();
  for (Eigen::Index first = 0; first < m_bandCount; first += kBlock, block += kBlock * m_count) {
    const auto bands = static_cast<std::size_t>(std::min(kBlock, m_bandCount - first));
    std::array<double, static_cast<std::size_t>(kBlock)> part{};
    std::copy_n(sum + first, bands, part.begin());
    HWY_DYNAMIC_DISPATCH(addBlock)(block, weights, static_cast<std::size_t>(m_count), part.data());
    std::copy_n(part.begin(), bands, sum + first);
  }
}

}  // namespace metamer::sip
#endif
