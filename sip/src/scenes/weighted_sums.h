// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace metamer::sip {

/// Spectra laid out for fast weighted sums of all of them. Sums are taken in the spectra's order, band by band, without
/// fused operations: the same bits whatever the instruction set.
class WeightedSums {
 public:
  WeightedSums() = default;
  /// @param spectra  bands x n
  explicit WeightedSums(const Eigen::MatrixXd& spectra);

  /// `spectra * weights`, a column a set; after the bands come up to kPadding - 1 zeros.
  /// @param weights  a column a set; n rows, and any number more that are not looked at
  Eigen::MatrixXd of(const Eigen::Ref<const Eigen::MatrixXd>& weights) const;

  Eigen::Index bandCount() const { return m_bandCount; }
  Eigen::Index count() const { return m_spectra.cols(); }
  /// The spectra, bands x n.
  auto spectra() const { return m_spectra.topRows(m_bandCount); }

  /// Spectra are padded with zeros to a multiple of so many bands.
  static constexpr Eigen::Index kPadding = 8;

 private:
  Eigen::Index m_bandCount = 0;
  Eigen::MatrixXd m_spectra;  ///< a column a spectrum, padded
};

}  // namespace metamer::sip
