// SPDX-License-Identifier: Apache-2.0
#include <Eigen/LU>
#include <array>
#include <cmath>

#include "metamer/spectral/argument_checks.h"
#include "metamer/spectral/colorimetry.h"
#include "metamer/spectral/input_error.h"
#include "metamer/stage/emitter_match.h"

namespace metamer::stage {
namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::Matrix3Xd;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

/// CIEDE2000 below which a difference counts by its square: from well-behaved to hardly distinguishable from the mean.
constexpr std::array<double, 4> kRoundings = {1.0, 0.1, 0.01, 0.001};
constexpr int kMostSteps = 100;
/// A step that gains less than this of the objective is the last.
constexpr double kSmallestGain = 1e-9;
constexpr int kMostHalvings = 20;
/// Of white's XYZ, for derivatives by central differences: rounding and curvature weigh alike.
constexpr double kDerivativeStep = 1e-5;

/// The patches' differences as they are seen, as a function of the drives.
class SeenChart {
 public:
  SeenChart(const MatchSystem& system, const SeenResponses& seen)
      : m_system(system), m_seen(seen), m_white(seen.xyzFromResponse * seen.white) {
    if (!(m_white.minCoeff() > 0)) {
      throw spectral::InputError("", "target", "", "is no white that can be seen by this observer; check both");
    }
    m_wanted.resize(3, system.target.size() / 3);
    for (Index i = 0; i < m_wanted.cols(); ++i) {
      m_wanted.col(i) = labOf(xyzOf(system.target.segment<3>(3 * i)));
    }
    m_shares = Eigen::ArrayXd::Constant(m_wanted.cols(), 1.0);
    if (seen.patchWeights.size() != 0) {
      spectral::requireAsMany("patch weights", seen.patchWeights.size(), "the patches", m_wanted.cols());
      m_shares = seen.patchWeights.array();
    }
    m_shares /= m_shares.sum();
  }

  Matrix3Xd differences(const VectorXd& drives) const {
    const VectorXd made = m_system.matrix * drives;
    Matrix3Xd differences(3, m_wanted.cols());
    for (Index i = 0; i < m_wanted.cols(); ++i) {
      differences.col(i) = difference(i, xyzOf(made.segment<3>(3 * i)));
    }
    return differences;
  }

  /// Weighted mean CIEDE2000; with a rounding r, of sqrt(CIEDE2000^2 + r^2).
  double mean(const VectorXd& drives, double rounding = 0) const {
    const Eigen::ArrayXd squares = differences(drives).colwise().squaredNorm().transpose().array();
    return ((squares + rounding * rounding).sqrt() * m_shares).sum();
  }

  /// The least-squares problem whose gradient at these drives is that of mean(): differences, linear in the drives,
  /// each divided by the square root of its size.
  MatchSystem linearised(const VectorXd& drives, double rounding) const {
    const VectorXd made = m_system.matrix * drives;
    MatchSystem linear{MatrixXd(m_system.matrix.rows(), m_system.matrix.cols()), VectorXd(m_system.target.size())};
    for (Index i = 0; i < m_wanted.cols(); ++i) {
      const Vector3d xyz = xyzOf(made.segment<3>(3 * i));
      const Vector3d now = difference(i, xyz);
      Matrix3d slopes;
      for (Index k = 0; k < 3; ++k) {
        const Vector3d step = kDerivativeStep * m_white[k] * Vector3d::Unit(k);
        slopes.col(k) = (difference(i, xyz + step) - difference(i, xyz - step)) / (2 * step[k]);
      }
      const MatrixXd rows = slopes * m_seen.xyzFromResponse * m_system.matrix.middleRows<3>(3 * i);
      const double weight = std::sqrt(m_shares[i]) * std::pow(now.squaredNorm() + rounding * rounding, -0.25);
      linear.matrix.middleRows<3>(3 * i) = weight * rows;
      linear.target.segment<3>(3 * i) = weight * (rows * drives - now);
    }
    return linear;
  }

 private:
  Vector3d xyzOf(const Vector3d& response) const { return m_seen.xyzFromResponse * response; }
  Vector3d labOf(const Vector3d& xyz) const { return spectral::lab(xyz, m_white); }
  Vector3d difference(Index patch, const Vector3d& xyz) const {
    return spectral::difference2000(m_wanted.col(patch), labOf(xyz));
  }

  const MatchSystem& m_system;
  const SeenResponses& m_seen;
  Vector3d m_white;
  Matrix3Xd m_wanted;       ///< Lab
  Eigen::ArrayXd m_shares;  ///< of each patch in the mean
};

/// Down to a minimum of the mean from some drives: every step is within the limits and lowers the objective.
VectorXd descend(const SeenChart& chart, VectorXd drives, const DriveLimits& limits) {
  for (const double rounding : kRoundings) {
    double objective = chart.mean(drives, rounding);
    for (int step = 0; step < kMostSteps; ++step) {
      const MatchSystem linear = chart.linearised(drives, rounding);
      const VectorXd direction = nonNegativeLeastSquares(linear.matrix, linear.target, limits).x - drives;
      double length = 1;
      double next = chart.mean(drives + direction, rounding);
      for (int halving = 0; halving < kMostHalvings && !(next < objective); ++halving) {
        length /= 2;
        next = chart.mean(drives + length * direction, rounding);
      }
      if (!(next < objective)) {
        break;
      }
      drives += length * direction;
      const double gain = objective - next;
      objective = next;
      if (gain < kSmallestGain * objective) {
        break;
      }
    }
  }
  return drives;
}

bool isWithin(const DriveLimits& limits, const VectorXd& drives) {
  constexpr double kRounding = 1 + 1e-12;
  return drives.minCoeff() >= 0 &&
         (limits.upper.size() == 0 || (drives.array() <= limits.upper.array() * kRounding).all()) &&
         (limits.power.size() == 0 || limits.power.dot(drives) <= limits.powerBudget * kRounding);
}

}  // namespace

EmitterMatch solvePerceptualMatch(const MatchSystem& system, const SeenResponses& seen,
                                  const std::vector<VectorXd>& starts, const DriveLimits& limits) {
  if (system.target.size() % 3 != 0) {
    throw spectral::InputError("", "target", std::to_string(system.target.size()), "must have three rows a patch");
  }
  for (const VectorXd& start : starts) {
    spectral::requireAsMany("drives of a start", start.size(), "the emitters", system.matrix.cols());
  }
  EmitterMatch match = solveMatch(system, limits);
  const SeenChart chart(system, seen);
  std::vector<VectorXd> ends = {match.drives, descend(chart, match.drives, limits)};
  for (const VectorXd& start : starts) {
    if (isWithin(limits, start)) {
      ends.push_back(start);
      ends.push_back(descend(chart, start, limits));
    }
  }
  double least = std::numeric_limits<double>::infinity();
  for (const VectorXd& end : ends) {
    const double mean = chart.mean(end);
    if (mean < least) {
      least = mean;
      match.drives = end;
    }
  }
  match.residualNorm = (system.matrix * match.drives - system.target).norm();
  match.relativeResidual = match.residualNorm / system.target.norm();
  return match;
}

}  // namespace metamer::stage
