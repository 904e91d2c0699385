// SPDX-License-Identifier: Apache-2.0
#include "least_squares/lawson_hanson.h"

#include <Eigen/QR>
#include <algorithm>
#include <limits>

namespace metamer::stage {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

MatrixXd columnsOf(const MatrixXd& matrix, const std::vector<Index>& columns) {
  MatrixXd result(matrix.rows(), static_cast<Index>(columns.size()));
  for (std::size_t k = 0; k < columns.size(); ++k) {
    result.col(static_cast<Index>(k)) = matrix.col(columns[k]);
  }
  return result;
}

namespace {

/// Least squares over some of the columns; nothing where they are dependent.
bool solveOn(const MatrixXd& matrix, const std::vector<Index>& columns, const VectorXd& target, VectorXd& solution) {
  Eigen::ColPivHouseholderQR<MatrixXd> factors(columnsOf(matrix, columns));
  factors.setThreshold(kDependentBelow);
  if (factors.rank() < static_cast<Index>(columns.size())) {
    return false;
  }
  const VectorXd part = factors.solve(target);
  solution = VectorXd::Zero(matrix.cols());
  for (std::size_t k = 0; k < columns.size(); ++k) {
    solution[columns[k]] = part[static_cast<Index>(k)];
  }
  return true;
}

/// Lawson and Hanson's NNLS on columns of unit length (or zero).
VectorXd solveUnit(const MatrixXd& matrix, const VectorXd& target) {
  const Index count = matrix.cols();
  VectorXd x = VectorXd::Zero(count);
  std::vector<bool> isFree(static_cast<std::size_t>(count), false);
  std::vector<bool> isRefused(static_cast<std::size_t>(count), false);
  const double tolerance = kGradientTolerance * target.norm();
  const auto freeColumns = [&] {
    std::vector<Index> columns;
    for (Index j = 0; j < count; ++j) {
      if (isFree[static_cast<std::size_t>(j)]) {
        columns.push_back(j);
      }
    }
    return columns;
  };
  for (Index round = 0; round < kMostRounds * count; ++round) {
    const VectorXd gradient = matrix.transpose() * (target - matrix * x);
    Index entering = -1;
    for (Index j = 0; j < count; ++j) {
      const auto at = static_cast<std::size_t>(j);
      if (!isFree[at] && !isRefused[at] && gradient[j] > tolerance &&
          (entering < 0 || gradient[j] > gradient[entering])) {
        entering = j;
      }
    }
    if (entering < 0) {
      return x;
    }
    isFree[static_cast<std::size_t>(entering)] = true;
    VectorXd candidate;
    if (!solveOn(matrix, freeColumns(), target, candidate) || !(candidate[entering] > 0)) {
      // Dependent on the others, or its gradient was rounding: no gain in it for now.
      isFree[static_cast<std::size_t>(entering)] = false;
      isRefused[static_cast<std::size_t>(entering)] = true;
      continue;
    }
    while (true) {
      double step = 1;
      Index blocking = -1;
      for (const Index j : freeColumns()) {
        if (candidate[j] <= 0 && x[j] / (x[j] - candidate[j]) < step) {
          step = x[j] / (x[j] - candidate[j]);
          blocking = j;
        }
      }
      if (blocking < 0) {
        break;
      }
      x += step * (candidate - x);
      for (const Index j : freeColumns()) {
        if (j == blocking || !(x[j] > 0)) {
          x[j] = 0;
          isFree[static_cast<std::size_t>(j)] = false;
        }
      }
      solveOn(matrix, freeColumns(), target, candidate);
    }
    x = candidate;
    std::fill(isRefused.begin(), isRefused.end(), false);
  }
  return x;
}

}  // namespace

VectorXd solveNonNegative(const MatrixXd& matrix, const VectorXd& target) {
  VectorXd scales(matrix.cols());
  for (Index j = 0; j < matrix.cols(); ++j) {
    const double length = matrix.col(j).stableNorm();
    scales[j] = length > std::numeric_limits<double>::min() ? 1 / length : 0;
  }
  return scales.cwiseProduct(solveUnit(matrix * scales.asDiagonal(), target));
}

VectorXd leastDistance(const MatrixXd& constraints, const VectorXd& bounds) {
  const Index size = constraints.cols();
  MatrixXd matrix(size + 1, constraints.rows());
  matrix.topRows(size) = constraints.transpose();
  matrix.bottomRows(1) = bounds.transpose();
  VectorXd target = VectorXd::Zero(size + 1);
  target[size] = 1;
  const VectorXd residual = matrix * solveNonNegative(matrix, target) - target;
  // A residual of nothing would mean constraints that contradict each other; x = 0 always keeps ours.
  return residual.head(size) / -std::min(residual[size], -std::numeric_limits<double>::min());
}

}  // namespace metamer::stage
