// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "scenes/weighted_sums.h"
#include "soft_bound/soft_bound_solver.h"

namespace metamer::sip {

/// What measured reflectances deviate from their own smooth spectrum, interpolated over chromaticity: the mean of a
/// Gaussian process (course notes, section 5.4, its triangles made smooth).
///
/// Chromaticity is `q = whitening * ((a_i - a_j) / n, (a_k - a_j) / n)`: a the white-normalised response, n its mean,
/// j the channel in the middle of the spectrum; the whitening makes the samples' covariance the identity, so that any
/// observer and light will do. The kernel is Matern's of order 3/2, `(1 + t) exp(-t)`, t = sqrt(3) |q - q'| / kReach:
/// without the cusps of an exponential, which a table would have to follow. The deviation of a colour is
/// `P(a) = max(n, 0) k(q) (K + diag noise)^-1 D`, D the samples' deviations for n = 1; it has no response of its own
/// (`weights * P = 0`), fades away from all samples, and is homogeneous of degree one. The perfect reflector is a
/// sample without noise, so neutrals stay on it.
///
/// Immutable after construction, safe to share between threads.
class MeasuredScene {
 public:
  /// In standard deviations of the samples' chromaticities.
  static constexpr double kReach = 2.0;
  /// Samples are taken as piecewise linear between so many nodes, 5 nm apart, whatever the solver's bands: as finely as
  /// they were measured, and as dear for any number of bands.
  static constexpr int kNodeCount = 81;

  /// @param solver        gives weights and smooth spectra. Copied from, not kept.
  /// @param reflectances  kNodeCount x n
  /// @param noise         n variances, 0 or more, over the kernel's 1: how far a sample is smoothed away between its
  ///                      neighbours. Samples that are dark under this light (mean response below 1e-4) are left out.
  MeasuredScene(const SoftBoundSolver& solver, const Eigen::MatrixXd& reflectances, const Eigen::VectorXd& noise);

  /// P for a white-normalised response.
  BandVector deviation(const Eigen::Vector3d& response) const;

  struct Local {
    BandVector value;  ///< P
    BandTriple slope;  ///< dP / dresponse
  };
  Local local(const Eigen::Vector3d& response) const;

 private:
  struct Chromaticity {
    double mean;  ///< n
    Eigen::Vector2d place;
    Eigen::Matrix<double, 2, 3> slope;  ///< dq / dresponse
  };
  Chromaticity chromaticityOf(const Eigen::Vector3d& response) const;
  /// The samples' spectra less their smooth ones, at the bands, from sums of coefficients.
  BandVector atBands(const Eigen::VectorXd& sums) const;

  Eigen::Matrix<double, 2, 3> m_differences;  ///< n q from a response
  Eigen::ArrayX2d m_places;                   ///< q of the samples
  WeightedSums m_coefficients;                ///< of the samples' kernels: nodes, then the response
  Eigen::VectorXi m_nodes;                    ///< of a band: it lies between this node and the next,
  Eigen::VectorXd m_fractions;                ///< so far from the first
  BandTriple m_smooth;                        ///< smooth spectrum from a response, less what its nodes give
};

}  // namespace metamer::sip
