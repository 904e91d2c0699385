// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace metamer::sip {

/// Measured samples as one observer under one light sees them, with the system of their kernels solved: all of a
/// MeasuredScene that does not depend on where the colours go. Immutable, safe to share between threads.
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

  /// @param weights       3 x B, each row's sum 1
  /// @param reflectances  kNodeCount x n
  /// @param noise         n variances (MeasuredScene)
  MeasuredSeeds(const Eigen::Matrix3Xd& weights, const Eigen::MatrixXd& reflectances, const Eigen::VectorXd& noise);

  Eigen::Matrix<double, 2, 3> differences;  ///< n q from a response, q in units of the kernel's length
  Eigen::ArrayX2d places;                   ///< q of the samples, the perfect reflector last
  /// (K + diag noise)^-1 of the samples' spectra at the nodes and, below, of their responses; for a mean of one.
  /// (kNodeCount + 3) x samples.
  Eigen::MatrixXd solved;
};

}  // namespace metamer::sip
