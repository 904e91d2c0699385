// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <limits>

namespace metamer::stage {

/// What drives may be, beside non-negative.
struct DriveLimits {
  Eigen::VectorXd upper;  ///< largest drive of each channel, positive or infinite; empty: none
  Eigen::VectorXd power;  ///< power of each channel at a drive of 1, not negative; empty: no budget
  double powerBudget = std::numeric_limits<double>::infinity();  ///< largest sum of power times drive

  bool empty() const { return upper.size() == 0 && power.size() == 0; }
};

struct LeastSquaresSolution {
  Eigen::VectorXd x;
  double residualNorm = 0;  ///< |A x - b|
  int rank = 0;             ///< of A: below its columns the minimiser is not unique, and x is the shortest one
};

/// Columns that nonNegativeLeastSquares takes.
inline constexpr int kMostDrives = 64;

/// argmin |A x - b| subject to x >= 0 and the limits; of several minimisers the one of least norm |x|.
///
/// The active-set method of Lawson and Hanson, "Solving Least Squares Problems" (1974), chapter 23: NNLS; the shortest
/// of several minimisers, and the limits, by their problems LDP and LSI, which NNLS solves. Columns are scaled to unit
/// length within, so channels may differ in size by many orders.
/// @param matrix  m x n, m >= 1, n 1 ... kMostDrives, finite; a column of zeros gets x = 0
/// @param target  m, finite
/// @throws spectral::InputError outside these, where the target has another length than m, and where limits have
///         another length than n or are not in their range
LeastSquaresSolution nonNegativeLeastSquares(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& target,
                                             const DriveLimits& limits = {});

}  // namespace metamer::stage
