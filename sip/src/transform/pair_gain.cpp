// SPDX-License-Identifier: Apache-2.0
#include "transform/pair_gain.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "soft_bound/soft_bound_solver.h"
#include "transform/perceptual_metric.h"

namespace metamer::sip {

namespace {

constexpr double kPercentile = 0.95;
/// Relaxations between which the largest that will do is sought: from plain adaptation to an exact match. Where a light
/// leaves a direction of response without any spectrum, what it asks for there is multiplied by the relaxation before
/// it cancels: a million times double precision's rounding.
constexpr double kLeastLogRelaxation = -12.0;
constexpr double kMostLogRelaxation = 20.0;
constexpr int kHalvings = 24;
/// A smooth spectrum that misses its response by more has none to meet it with.
constexpr double kMostMissed = 1e-6;
/// A surface this dark under the input light says nothing.
constexpr double kDarkest = 1e-4;

}  // namespace

double gainOf(const PairWeights& pair, const Eigen::MatrixXd& surfaces, double relaxation) {
  const SoftBoundSolver solver(pair.input, relaxation);
  const Eigen::Matrix3d missed = Eigen::Matrix3d::Identity() - pair.input * solver.unclamped();
  Eigen::Matrix3d matrix = pair.relativeFromSpectrum * solver.unclamped();
  if (relaxation > 0.0) {
    matrix += pair.relativeFromResponse * missed;
  } else if (!(missed.cwiseAbs().maxCoeff() < kMostMissed)) {
    return std::numeric_limits<double>::infinity();
  }
  const Eigen::Matrix3d responseFromRelative = pair.relativeFromResponse.inverse();
  const Eigen::Matrix3d relativeFromRelative = matrix * responseFromRelative;
  std::vector<double> gains;
  for (Eigen::Index i = 0; i < surfaces.cols(); ++i) {
    const Eigen::Vector3d response = pair.input * surfaces.col(i);
    if (response.minCoeff() < kDarkest) {
      continue;
    }
    const Eigen::Vector3d in = pair.relativeFromResponse * response;
    const Eigen::Matrix3d before = PerceptualMetric::atRelative(in);
    const Eigen::Matrix3d after = PerceptualMetric::atRelative(matrix * response);
    const Eigen::Matrix3d gain = after * relativeFromRelative * before.inverse();
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> squares;
    squares.computeDirect(gain.transpose() * gain, Eigen::EigenvaluesOnly);
    gains.push_back(std::sqrt(squares.eigenvalues()[2]));
  }
  if (gains.empty()) {
    return 0.0;
  }
  const auto rank = static_cast<std::ptrdiff_t>(kPercentile * static_cast<double>(gains.size() - 1));
  std::nth_element(gains.begin(), gains.begin() + rank, gains.end());
  const double percentile = gains[static_cast<std::size_t>(rank)];
  return std::isfinite(percentile) ? percentile : std::numeric_limits<double>::infinity();
}

double relaxationOf(const PairWeights& pair, const Eigen::MatrixXd& surfaces) {
  if (gainOf(pair, surfaces, 0.0) <= kLargestGain) {
    return 0.0;
  }
  double low = kLeastLogRelaxation;
  double high = kMostLogRelaxation;
  for (int halving = 0; halving < kHalvings; ++halving) {
    const double middle = 0.5 * (low + high);
    (gainOf(pair, surfaces, std::exp2(middle)) <= kLargestGain ? low : high) = middle;
  }
  return std::exp2(low);
}

}  // namespace metamer::sip
