// SPDX-License-Identifier: Apache-2.0
#include "metamer/stage/non_negative_least_squares.h"

#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "least_squares/lawson_hanson.h"
#include "least_squares/limited_descent.h"
#include "metamer/spectral/argument_checks.h"
#include "metamer/spectral/input_error.h"

namespace metamer::stage {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// A gradient that is nothing: the channel may take part in another minimiser.
constexpr double kTied = 1e-12;
/// Equations hold to this, relative to the solution.
constexpr double kFits = 1e-13;

/// The shortest x >= 0 with `rows` x = `values`, whose rows are orthonormal.
VectorXd shortest(const MatrixXd& rows, const VectorXd& values, const VectorXd& known) {
  const Index count = rows.cols();
  const double size = std::max(values.norm(), std::numeric_limits<double>::min());
  MatrixXd constraints(count + 2 * rows.rows(), count);
  constraints << MatrixXd::Identity(count, count), rows, -rows;
  VectorXd bounds(constraints.rows());
  bounds << VectorXd::Zero(count), values / size, -values / size;
  const VectorXd rough = leastDistance(constraints, bounds) * size;
  // The same point from its own equations, free of the detour's rounding, which also hides what is barely positive.
  for (const double threshold : {1e-9, 1e-11, 1e-13}) {
    std::vector<Index> positive;
    for (Index j = 0; j < count; ++j) {
      if (rough[j] > threshold * size) {
        positive.push_back(j);
      }
    }
    if (positive.empty()) {
      continue;
    }
    Eigen::CompleteOrthogonalDecomposition<MatrixXd> factors(columnsOf(rows, positive));
    factors.setThreshold(kDependentBelow);
    const VectorXd part = factors.solve(values);
    VectorXd x = VectorXd::Zero(count);
    for (std::size_t k = 0; k < positive.size(); ++k) {
      x[positive[k]] = part[static_cast<Index>(k)];
    }
    if (x.minCoeff() >= 0 && (rows * x - values).norm() <= kFits * size && x.norm() <= known.norm()) {
      return x;
    }
  }
  return known;
}

/// The shortest minimiser, given one. Where the gradient at one pushes a channel down, it is 0 in all of them.
VectorXd shortestMinimiser(const MatrixXd& matrix, const VectorXd& target, const VectorXd& known) {
  const VectorXd gradient = matrix.transpose() * (target - matrix * known);
  std::vector<Index> columns;
  for (Index j = 0; j < matrix.cols(); ++j) {
    if (known[j] > 0 || gradient[j] > -kTied * matrix.col(j).norm() * target.norm()) {
      columns.push_back(j);
    }
  }
  const MatrixXd tied = columnsOf(matrix, columns);
  const Eigen::JacobiSVD<MatrixXd> parts(tied, Eigen::ComputeThinU | Eigen::ComputeThinV);
  const VectorXd& sizes = parts.singularValues();
  const Index rank = (sizes.array() > kDependentBelow * sizes[0]).count();
  if (rank == tied.cols()) {
    return known;
  }
  VectorXd part(tied.cols());
  for (Index k = 0; k < part.size(); ++k) {
    part[k] = known[columns[static_cast<std::size_t>(k)]];
  }
  // What the rows make, by way of what the matrix makes: large entries that cancel leave no rounding in it.
  const VectorXd values = (parts.matrixU().leftCols(rank).transpose() * (tied * part)).cwiseQuotient(sizes.head(rank));
  VectorXd x = VectorXd::Zero(matrix.cols());
  part = shortest(parts.matrixV().leftCols(rank).transpose(), values, part);
  for (Index k = 0; k < part.size(); ++k) {
    x[columns[static_cast<std::size_t>(k)]] = part[k];
  }
  const auto distance = [&](const VectorXd& at) { return (matrix * at - target).norm(); };
  return distance(x) <= distance(known) + kDependentBelow * target.norm() ? x : known;
}

bool keeps(const DriveLimits& limits, const VectorXd& x) {
  return (limits.upper.size() == 0 || (x.array() <= limits.upper.array()).all()) &&
         (limits.power.size() == 0 || limits.power.dot(x) <= limits.powerBudget);
}

void check(const DriveLimits& limits, Index count) {
  const auto refuse = [](const char* field, double value, const char* remedy) {
    throw spectral::InputError("", field, std::to_string(value), remedy);
  };
  for (const auto* values : {&limits.upper, &limits.power}) {
    if (values->size() != 0 && values->size() != count) {
      refuse(values == &limits.upper ? "limits" : "power", static_cast<double>(values->size()),
             "must be as many as the emitters");
    }
  }
  for (const double value : limits.upper) {
    if (!(value > 0)) {
      refuse("limits", value, "must be above 0");
    }
  }
  for (const double value : limits.power) {
    if (!(value >= 0) || !std::isfinite(value)) {
      refuse("power", value, "must be 0 or more");
    }
  }
  if (!(limits.powerBudget > 0)) {
    refuse("power budget", limits.powerBudget, "must be above 0");
  }
}

}  // namespace

LeastSquaresSolution nonNegativeLeastSquares(const MatrixXd& matrix, const VectorXd& target,
                                             const DriveLimits& limits) {
  const Index count = matrix.cols();
  spectral::requireWithin("columns", static_cast<double>(count), 1, kMostDrives);
  spectral::requireWithin("rows", static_cast<double>(matrix.rows()), 1, std::numeric_limits<int>::max());
  spectral::requireAsMany("target", target.size(), "the rows of the matrix", matrix.rows());
  if (!matrix.allFinite() || !target.allFinite()) {
    throw spectral::InputError("", matrix.allFinite() ? "target" : "matrix", "", "holds numbers that are not finite");
  }
  check(limits, count);
  // As many rows as columns hold the whole problem.
  MatrixXd reduced = matrix;
  VectorXd reducedTarget = target;
  if (matrix.rows() > count) {
    const Eigen::HouseholderQR<MatrixXd> factors(matrix);
    reduced = factors.matrixQR().topRows(count).triangularView<Eigen::Upper>();
    reducedTarget = (factors.householderQ().transpose() * target).head(count);
  }
  LeastSquaresSolution solution;
  solution.x = solveNonNegative(reduced, reducedTarget);
  const VectorXd sizes = Eigen::JacobiSVD<MatrixXd>(reduced).singularValues();
  solution.rank = static_cast<int>((sizes.array() > kDependentBelow * sizes[0]).count());
  if (solution.rank < count && solution.x.squaredNorm() > 0) {
    solution.x = shortestMinimiser(reduced, reducedTarget, solution.x);
  }
  if (!limits.empty() && !keeps(limits, solution.x)) {
    solution.x = solveLimited(reduced, reducedTarget, limits);
  }
  solution.residualNorm = (matrix * solution.x - target).norm();
  return solution;
}

}  // namespace metamer::stage
