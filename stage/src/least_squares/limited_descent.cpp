// SPDX-License-Identifier: Apache-2.0
#include "least_squares/limited_descent.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "least_squares/lawson_hanson.h"

namespace metamer::stage {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Rows that make a dependent system unique in LSI, relative to the largest singular value: the shortest solution to
/// within their square.
constexpr double kRidge = 1e-7;

/// Lawson and Hanson's LSI with x >= 0 and the limits. `matrix` has no more rows than columns plus the ridge's.
VectorXd nearlyLimited(const MatrixXd& matrix, const VectorXd& target, const DriveLimits& limits) {
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
    factors.setThreshold(kDependentBelow);
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

}  // namespace

VectorXd solveLimited(const MatrixXd& matrix, const VectorXd& target, const DriveLimits& limits) {
  const VectorXd rough = clampedTo(limits, nearlyLimited(matrix, target, limits));
  return clampedTo(limits, LimitedDescent(matrix, target, limits, rough).run());
}

}  // namespace metamer::stage
