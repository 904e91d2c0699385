// SPDX-License-Identifier: Apache-2.0
// A C door to the non-negative least squares, so that scipy can judge it on the same numbers.
#include <algorithm>
#include <limits>

#include "metamer/stage/non_negative_least_squares.h"

/// matrix: rows x columns, row by row; upper, power: columns values or null; budget: used with power; x: out.
/// @return the residual's norm
extern "C" double metamerLeastSquares(const double* matrix, int rows, int columns, const double* target,
                                      const double* upper, const double* power, double budget, double* x) {
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  metamer::stage::DriveLimits limits;
  if (upper != nullptr) {
    limits.upper = Eigen::Map<const Eigen::VectorXd>(upper, columns);
  }
  if (power != nullptr) {
    limits.power = Eigen::Map<const Eigen::VectorXd>(power, columns);
    limits.powerBudget = budget;
  }
  const auto solution = metamer::stage::nonNegativeLeastSquares(
      Eigen::Map<const RowMajor>(matrix, rows, columns), Eigen::Map<const Eigen::VectorXd>(target, rows), limits);
  std::copy(solution.x.begin(), solution.x.end(), x);
  return solution.residualNorm;
}
