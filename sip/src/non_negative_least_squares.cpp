// SPDX-License-Identifier: Apache-2.0
#include "metamer/sip/non_negative_least_squares.h"

#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "metamer/spectral/input_error.h"

namespace metamer::sip {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// A gradient below this, of unit columns and a unit target, is rounding.
constexpr double kGradientTolerance = 1e-14;
/// Columns whose part outside the others' span is below this are dependent.
constexpr double kRankTolerance = 1e-12;
/// Rows that make a dependent system unique in LSI, relative to the largest singular value: the shortest solution to
/// within their square.
constexpr double kRidge = 1e-7;
/// A gradient that is nothing: the channel may take part in another minimiser.
constexpr double kTied = 1e-12;
/// Equations hold to this, relative to the solution.
constexpr double kFits = 1e-13;
/// Rounds a column: far more than is ever needed, so that rounding cannot make a cycle.
constexpr Index kMostRounds = 50;

MatrixXd columnsOf(const MatrixXd& matrix, const std::vector<Index>& columns) {
  MatrixXd result(matrix.rows(), static_cast<Index>(columns.size()));
  for (std::size_t k = 0; k < columns.size(); ++k) {
    result.col(static_cast<Index>(k)) = matrix.col(columns[k]);
  }
  return result;
}

/// Least squares over some of the columns; nothing where they are dependent.
bool solveOn(const MatrixXd& matrix, const std::vector<Index>& columns, const VectorXd& target, VectorXd& solution) {
  Eigen::ColPivHouseholderQR<MatrixXd> factors(columnsOf(matrix, columns));
  factors.setThreshold(kRankTolerance);
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

VectorXd solveNonNegative(const MatrixXd& matrix, const VectorXd& target) {
  VectorXd scales(matrix.cols());
  for (Index j = 0; j < matrix.cols(); ++j) {
    const double length = matrix.col(j).stableNorm();
    scales[j] = length > std::numeric_limits<double>::min() ? 1 / length : 0;
  }
  return scales.cwiseProduct(solveUnit(matrix * scales.asDiagonal(), target));
}

/// argmin |z| subject to G z >= h (Lawson and Hanson's LDP). Rows of G may have any length.
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
    factors.setThreshold(kRankTolerance);
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
  const Index rank = (sizes.array() > kRankTolerance * sizes[0]).count();
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
  return distance(x) <= distance(known) + kRankTolerance * target.norm() ? x : known;
}

/// Lawson and Hanson's LSI with x >= 0 and the limits. `matrix` has no more rows than columns plus the ridge's.
VectorXd solveLimited(const MatrixXd& matrix, const VectorXd& target, const DriveLimits& limits) {
  const Index count = matrix.cols();
  const double ridge = kRidge * std::max(matrix.norm(), std::numeric_limits<double>::min());
  MatrixXd extended(matrix.rows() + count, count);
  extended << matrix, ridge * MatrixXd::Identity(count, count);
  VectorXd extendedTarget = VectorXd::Zero(extended.rows());
  extendedTarget.head(target.size()) = target;
  const Eigen::HouseholderQR<MatrixXd> factors(extended);
  const MatrixXd upperTriangle = factors.matrixQR().topRows(count).triangularView<Eigen::Upper>();
  const VectorXd rotated = (factors.householderQ().transpose() * extendedTarget).head(count);

  std::vector<VectorXd> rows;
  std::vector<double> bounds;
  for (Index j = 0; j < count; ++j) {
    rows.push_back(VectorXd::Unit(count, j));
    bounds.push_back(0);
    if (limits.upper.size() > 0 && std::isfinite(limits.upper[j])) {
      rows.push_back(-VectorXd::Unit(count, j));
      bounds.push_back(-limits.upper[j]);
    }
  }
  if (limits.power.size() > 0 && std::isfinite(limits.powerBudget)) {
    rows.push_back(-limits.power);
    bounds.push_back(-limits.powerBudget);
  }
  const auto total = static_cast<Index>(rows.size());
  MatrixXd constraints(total, count);
  for (Index i = 0; i < total; ++i) {
    constraints.row(i) = rows[static_cast<std::size_t>(i)].transpose();
  }
  const VectorXd limitsOfRows = Eigen::Map<const VectorXd>(bounds.data(), total);
  // z = R x - Q'b, so the constraints become G R^-1 z >= h - G R^-1 Q'b.
  const MatrixXd transformed =
      upperTriangle.triangularView<Eigen::Upper>().transpose().solve(constraints.transpose()).transpose();
  VectorXd shifted = limitsOfRows - transformed * rotated;
  const double size = std::max(shifted.cwiseAbs().maxCoeff(), std::numeric_limits<double>::min());
  const VectorXd z = shifted.maxCoeff() <= 0 ? VectorXd(VectorXd::Zero(count))
                                             : VectorXd(leastDistance(transformed, shifted / size) * size);
  return upperTriangle.triangularView<Eigen::Upper>().solve(z + rotated);
}

/// Where a primal active-set method stands: what each channel rests on.
class LimitedDescent {
 public:
  LimitedDescent(const MatrixXd& matrix, const VectorXd& target, const DriveLimits& limits, VectorXd start)
      : m_matrix(matrix), m_target(target), m_limits(limits), m_x(std::move(start)) {
    const double size = std::max(m_x.maxCoeff(), std::numeric_limits<double>::min());
    for (Index j = 0; j < m_x.size(); ++j) {
      const bool isLow = m_x[j] <= kTouching * size;
      const bool isHigh = m_x[j] >= upper(j) * (1 - kTouching);
      m_x[j] = isLow ? 0 : isHigh ? upper(j) : m_x[j];
      m_isFree.push_back(!isLow && !isHigh);
    }
    m_spends = hasBudget() && spent() >= m_limits.powerBudget * (1 - kTouching);
  }

  /// Down to the minimum from a point that is close to it: every round lowers the sum of squares or ends.
  VectorXd run() {
    for (Index round = 0; round < kMostRounds * m_x.size(); ++round) {
      if (descend() && !release()) {
        break;
      }
    }
    return m_x;
  }

 private:
  static constexpr double kTouching = 1e-9;

  double upper(Index j) const {
    return m_limits.upper.size() > 0 ? m_limits.upper[j] : std::numeric_limits<double>::infinity();
  }
  bool hasBudget() const { return m_limits.power.size() > 0 && std::isfinite(m_limits.powerBudget); }
  double spent() const { return m_limits.power.dot(m_x); }
  std::vector<Index> freeColumns() const {
    std::vector<Index> columns;
    for (Index j = 0; j < m_x.size(); ++j) {
      if (m_isFree[static_cast<std::size_t>(j)]) {
        columns.push_back(j);
      }
    }
    return columns;
  }

  /// To the minimum over the free channels, or to the first limit in the way. @return whether it got there
  bool descend() {
    const std::vector<Index> columns = freeColumns();
    const auto count = static_cast<Index>(columns.size());
    if (count <= (m_spends ? 1 : 0)) {
      return true;
    }
    MatrixXd basis = MatrixXd::Identity(count, count);
    VectorXd power = VectorXd::Zero(count);
    if (hasBudget()) {
      for (Index k = 0; k < count; ++k) {
        power[k] = m_limits.power[columns[static_cast<std::size_t>(k)]];
      }
    }
    if (m_spends && power.norm() > 0) {
      // Steps that spend nothing: across the powers.
      basis = (Eigen::HouseholderQR<MatrixXd>(power).householderQ() * basis).rightCols(count - 1);
    }
    Eigen::CompleteOrthogonalDecomposition<MatrixXd> factors(columnsOf(m_matrix, columns) * basis);
    factors.setThreshold(kRankTolerance);
    const VectorXd step = basis * factors.solve(m_target - m_matrix * m_x);
    double length = 1;
    Index blocking = -1;
    bool isBudget = false;
    for (Index k = 0; k < count; ++k) {
      const Index j = columns[static_cast<std::size_t>(k)];
      const double room = step[k] < 0 ? -m_x[j] : upper(j) - m_x[j];
      if (step[k] != 0 && room / step[k] < length) {
        length = std::max(0.0, room / step[k]);
        blocking = j;
      }
    }
    const double spends = power.dot(step);
    if (hasBudget() && !m_spends && spends > 0 && (m_limits.powerBudget - spent()) / spends < length) {
      length = std::max(0.0, (m_limits.powerBudget - spent()) / spends);
      isBudget = true;
    }
    for (Index k = 0; k < count; ++k) {
      m_x[columns[static_cast<std::size_t>(k)]] += length * step[k];
    }
    if (isBudget) {
      m_spends = true;
    } else if (blocking >= 0) {
      m_x[blocking] = m_x[blocking] < 0.5 * upper(blocking) ? 0 : upper(blocking);
      m_isFree[static_cast<std::size_t>(blocking)] = false;
    }
    return !isBudget && blocking < 0;
  }

  /// Frees the channel, or the budget, that promises most. @return false where none does: the minimum
  bool release() {
    const VectorXd gradient = m_matrix.transpose() * (m_target - m_matrix * m_x);
    double price = 0;
    if (m_spends) {
      double powers = 0;
      for (const Index j : freeColumns()) {
        price += gradient[j] * m_limits.power[j];
        powers += m_limits.power[j] * m_limits.power[j];
      }
      if (!(powers > 0)) {
        return false;
      }
      price /= powers;
      if (price < -kGradientTolerance * m_matrix.norm() * m_target.norm()) {
        m_spends = false;
        return true;
      }
    }
    Index best = -1;
    double bestGain = 1e2 * kGradientTolerance;
    for (Index j = 0; j < m_x.size(); ++j) {
      if (m_isFree[static_cast<std::size_t>(j)]) {
        continue;
      }
      const double slope = gradient[j] - (m_spends ? price * m_limits.power[j] : 0);
      const double size = m_matrix.col(j).norm() * m_target.norm();
      const double gain = (m_x[j] > 0 ? -slope : slope) / std::max(size, std::numeric_limits<double>::min());
      if (gain > bestGain) {
        best = j;
        bestGain = gain;
      }
    }
    if (best >= 0) {
      m_isFree[static_cast<std::size_t>(best)] = true;
    }
    return best >= 0;
  }

  const MatrixXd& m_matrix;
  const VectorXd& m_target;
  const DriveLimits& m_limits;
  VectorXd m_x;
  std::vector<bool> m_isFree;
  bool m_spends = false;  // the whole budget
};

/// Within the limits to the last digit.
VectorXd clampedTo(const DriveLimits& limits, VectorXd x) {
  x = x.cwiseMax(0.0);
  if (limits.upper.size() > 0) {
    x = x.cwiseMin(limits.upper);
  }
  if (limits.power.size() > 0) {
    const double power = limits.power.dot(x);
    if (power > limits.powerBudget) {
      x *= limits.powerBudget / power;
    }
  }
  return x;
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
  solution.rank = static_cast<int>((sizes.array() > kRankTolerance * sizes[0]).count());
  if (solution.rank < count && solution.x.squaredNorm() > 0) {
    solution.x = shortestMinimiser(reduced, reducedTarget, solution.x);
  }
  if (!limits.empty() && !keeps(limits, solution.x)) {
    const VectorXd rough = clampedTo(limits, solveLimited(reduced, reducedTarget, limits));
    solution.x = clampedTo(limits, LimitedDescent(reduced, reducedTarget, limits, rough).run());
  }
  solution.residualNorm = (matrix * solution.x - target).norm();
  return solution;
}

}  // namespace metamer::sip
