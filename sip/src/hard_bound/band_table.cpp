// SPDX-License-Identifier: Apache-2.0
#include "hard_bound/band_table.h"

namespace metamer::sip {

BandTable::BandTable(const Eigen::Matrix3Xd& weights) : m_channels(weights.transpose().array()) {
  m_weights.resize(static_cast<std::size_t>(weights.cols()));
  for (Eigen::Index b = 0; b < weights.cols(); ++b) {
    m_weights[static_cast<std::size_t>(b)] << weights.col(b).array(), 0.0;
  }
  for (int first = 0; first + kBlock <= bandCount(); first += kBlock) {
    addBands(first, first + kBlock, first, m_blocks.emplace_back());
  }
}

void BandTable::addBands(int from, int to, int first, RunSums& sums) const {
  // In registers: through memory each step would wait for the last one's store.
  RunSums running = sums;
  for (int b = from; b < to; ++b) {
    const Eigen::Array4d& a = weight(b);
    running.moment += static_cast<double>(b - first + 1) * a;
    running.product[0] += a[0] * running.curve;
    running.product[1] += a[1] * running.curve;
    running.product[2] += a[2] * running.curve;
    running.weight += a;
    running.curve += running.weight;
  }
  sums = running;
}

Eigen::Vector3d BandTable::sumOf(const Eigen::VectorXd& spectrum) const {
  Eigen::Array4d sum = Eigen::Array4d::Zero();
  for (int b = 0; b < bandCount(); ++b) {
    sum += weight(b) * spectrum[b];
  }
  return sum.matrix().head<3>();
}

RunSums BandTable::sumsOver(int first, int end) const {
  RunSums sums;
  const int firstBlock = (first + kBlock - 1) / kBlock;
  const int endBlock = end / kBlock;
  if (firstBlock >= endBlock) {
    addBands(first, end, first, sums);
    return sums;
  }
  addBands(first, firstBlock * kBlock, first, sums);
  for (int block = firstBlock; block < endBlock; ++block) {
    // Inside, the run's curve is Q + slope * (b - start) + the block's own curve.
    const RunSums& own = m_blocks[static_cast<std::size_t>(block)];
    const Eigen::Array4d step = own.moment - own.weight;  // sum of (b - start) A
    for (std::size_t k = 0; k < 3; ++k) {
      const auto lane = static_cast<Eigen::Index>(k);
      sums.product[k] += own.weight[lane] * sums.curve + step[lane] * sums.weight + own.product[k];
    }
    sums.moment += own.moment + static_cast<double>(block * kBlock - first) * own.weight;
    sums.curve += static_cast<double>(kBlock) * sums.weight + own.curve;
    sums.weight += own.weight;
  }
  addBands(endBlock * kBlock, end, first, sums);
  return sums;
}

}  // namespace metamer::sip
