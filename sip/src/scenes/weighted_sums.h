// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

namespace metamer::sip {

/// Spectra laid out for fast weighted sums of all of them. Sums are taken in the spectra's order, band by band, without
/// fused operations: the same bits whatever the instruction set.
class WeightedSums {
 public:
  WeightedSums() = default;
  /// @param spectra  bands x n
  explicit WeightedSums(const Eigen::MatrixXd& spectra);

  /// `spectra * weights`, bands x sets.
  /// @param weights  n x sets, one or three sets
  Eigen::MatrixXd of(const Eigen::ArrayXXd& weights) const;

  Eigen::Index bandCount() const { return m_bandCount; }
  Eigen::Index count() const { return m_count; }

  /// Bands that lie together: every spectrum's first kBlock bands, then every one's next, padded with zeros.
  static constexpr Eigen::Index kBlock = 32;

 private:
  Eigen::Index m_bandCount = 0;
  Eigen::Index m_count = 0;
  std::vector<double> m_blocks;
};

}  // namespace metamer::sip
