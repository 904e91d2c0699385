// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

namespace metamer::sip {

/// A few of many places whose kernels say nearly all that the kernels of all do (Cholesky's factorisation with
/// pivots, stopped early; Foster and others, Stable and efficient Gaussian process calculations, 2009).
struct LeadingPlaces {
  std::vector<Eigen::Index> chosen;  ///< in the order in which they were
  /// A row a place, a column a chosen one: `features * features'` is the kernel between all places, less what the
  /// chosen ones cannot say of it. Exact in the rows and columns of the chosen, where it is triangular.
  Eigen::MatrixXd features;

  /// @param places  n x 2, of SampleKernel
  /// @param first   so many are chosen before all others, in their order, unless those before them say all of them;
  ///                then always the one of which least is said
  /// @param most    how many are chosen at most; `first` where that is more
  LeadingPlaces(const Eigen::ArrayX2d& places, Eigen::Index first, Eigen::Index most);
};

}  // namespace metamer::sip
