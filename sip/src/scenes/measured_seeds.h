// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace metamer::sip {

/// Measured samples as one observer under one light sees them, with the system of their kernels solved: all of a
/// MeasuredScene that does not depend on where the colours go. Of many samples a few stand for all: every sample pulls
/// at their sum as it would at the sum of all (a Gaussian process by the subset of regressors; Quinonero-Candela and
/// Rasmussen, A unifying view of sparse approximate Gaussian process regression, 2005). Immutable, safe to share
/// between threads.
///
/// Chromaticity is `q = whitening * ((a_i - a_j) / n, (a_k - a_j) / n)`: a the white-normalised response, n its mean,
/// j the channel in the middle of the spectrum; the whitening makes the samples' covariance the identity, so that any
/// observer and light will do.
struct MeasuredSeeds {
  /// In standard deviations of the samples' chromaticities.
  static constexpr double kReach = 2.0;
  /// Samples are taken as piecewise linear between so many nodes, 5 nm apart, whatever the solver's bands: as finely as
  /// they were measured, and as dear for any number of bands.
  static constexpr int kNodeCount = 81;
  /// Samples that stand for all, the perfect reflector among them: on metamer's own sets within 0.1 CIEDE2000 of all
  /// at a third of the work for a colour. Those without noise all stand for themselves.
  static constexpr int kMostSeeds = 160;

  /// @param weights       3 x B, each row's sum 1
  /// @param reflectances  kNodeCount x n
  /// @param noise         n variances (MeasuredScene)
  MeasuredSeeds(const Eigen::Matrix3Xd& weights, const Eigen::MatrixXd& reflectances, const Eigen::VectorXd& noise);

  Eigen::Matrix<double, 2, 3> differences;  ///< n q from a response, q in units of the kernel's length
  Eigen::ArrayX2d places;                   ///< q of the seeds, the perfect reflector first
  /// What the seeds' kernels are multiplied with to give spectra at the nodes and, below, their responses; for a mean
  /// of one. (kNodeCount + 3) x seeds.
  Eigen::MatrixXd solved;
};

}  // namespace metamer::sip
