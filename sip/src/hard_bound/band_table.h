// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "metamer/sip/band_weights.h"

namespace metamer::sip {

/// Sums over one run of bands, first ... end - 1. The curve Q is the twice-summed weight of the run: Q = 0 at first - 1
/// and at first, and Q[b+1] - 2 Q[b] + Q[b-1] = A[b]. Lanes are the three channels, then zero.
struct RunSums {
  Eigen::Array4d weight = Eigen::Array4d::Zero();  ///< sum of A: the curve's slope behind the run
  Eigen::Array4d moment = Eigen::Array4d::Zero();  ///< sum of (b - first + 1) A
  Eigen::Array4d curve = Eigen::Array4d::Zero();   ///< Q[end]
  /// Row k: sum of A[k] Q.
  std::array<Eigen::Array4d, 3> product = {Eigen::Array4d::Zero(), Eigen::Array4d::Zero(), Eigen::Array4d::Zero()};
};

/// The weights of all bands with the sums over whole blocks of them, so that sums over a run cost a block a step.
/// Everything is a sum of products of non-negative numbers: no digits are lost however small the weights are.
class BandTable {
 public:
  /// @param weights 3 x B
  explicit BandTable(const Eigen::Matrix3Xd& weights);

  int bandCount() const { return static_cast<int>(m_weights.size()); }
  const Eigen::Array4d& weight(int band) const { return m_weights[static_cast<std::size_t>(band)]; }
  /// The weights again, a column a channel.
  const Eigen::ArrayX3d& channels() const { return m_channels; }
  RunSums sumsOver(int first, int end) const;
  /// The weights' sums of a spectrum.
  Eigen::Vector3d sumOf(const Eigen::VectorXd& spectrum) const;

 private:
  static constexpr int kBlock = 16;

  void addBands(int from, int to, int first, RunSums& sums) const;

  std::vector<Eigen::Array4d> m_weights;
  Eigen::ArrayX3d m_channels;
  std::vector<RunSums> m_blocks;
};

}  // namespace metamer::sip
