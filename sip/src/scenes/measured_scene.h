// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>

#include "scenes/measured_seeds.h"
#include "scenes/node_bands.h"
#include "scenes/sample_kernel.h"
#include "scenes/skin_gaussian.h"
#include "scenes/weighted_sums.h"
#include "soft_bound/soft_bound_solver.h"

namespace metamer::sip {

/// What measured reflectances deviate from their own smooth spectrum, interpolated over chromaticity: the mean of a
/// Gaussian process (course notes, section 5.4, its triangles made smooth).
///
/// Chromaticity q is as in MeasuredSeeds. The kernel is Matern's of order 3/2, `(1 + t) exp(-t)`, t = sqrt(3) |q - q'|
/// / kReach: without the cusps of an exponential, which a table would have to follow. The deviation of a colour is
/// `P(a) = max(n, 0) k(q) (K + diag noise)^-1 D`, D the samples' deviations for n = 1; it has no response of its own
/// (`weights * P = 0`), fades away from all samples, and is homogeneous of degree one. The perfect reflector is a
/// sample without noise, so neutrals stay on it.
///
/// Immutable after construction, safe to share between threads.
class MeasuredScene {
 public:
  static constexpr int kNodeCount = MeasuredSeeds::kNodeCount;

  /// @param solver  gives smooth spectra. Copied from, not kept.
  /// @param seeds   of the solver's weights; likewise
  /// @param skin    where given, takes its share of P from the samples; of the same weights and places
  MeasuredScene(const SoftBoundSolver& solver, const MeasuredSeeds& seeds,
                const std::optional<SkinGaussian>& skin = std::nullopt);
  /// @param reflectances  kNodeCount x n
  /// @param noise         n variances, 0 or more, over the kernel's 1: how far a sample is smoothed away between its
  ///                      neighbours. Samples that are dark under this light (mean response below 1e-4) are left out.
  MeasuredScene(const SoftBoundSolver& solver, const Eigen::MatrixXd& reflectances, const Eigen::VectorXd& noise)
      : MeasuredScene(solver, MeasuredSeeds(solver.weights(), reflectances, noise)) {}

  /// P for white-normalised responses, a column each: B x n.
  Eigen::MatrixXd deviations(const Eigen::Matrix3Xd& responses) const;
  BandVector deviation(const Eigen::Vector3d& response) const { return deviations(response); }

  struct Local {
    BandVector value;  ///< P
    BandTriple slope;  ///< dP / dresponse
  };
  Local local(const Eigen::Vector3d& response) const;

  /// How much of each sample, and of the Gaussian's three spectra, a colour takes, and how that changes: what slopes
  /// are summed from.
  struct Mixture {
    double mean;                             ///< n
    Eigen::Matrix<double, 2, 3> placeSlope;  ///< dq / dresponse
    Eigen::MatrixX3d kernel;                 ///< k(q), and its derivatives
  };
  /// None where P is nothing.
  std::optional<Mixture> mixture(const Eigen::Vector3d& response) const;
  Local local(const Mixture& mixture) const;

  /// The samples as `weights` (3 x B) see them, for slopes where no spectrum is asked for.
  WeightedSums seenBy(const Eigen::Matrix3Xd& weights) const;
  /// `weights * dP / dresponse`
  /// @param seen  seenBy(weights)
  static Eigen::Matrix3d slope(const Mixture& mixture, const WeightedSums& seen);

 private:
  struct Chromaticity {
    double mean;            ///< n
    Eigen::Vector2d place;  ///< q
  };
  Chromaticity chromaticityOf(const Eigen::Vector3d& response) const;
  /// The kernel at a place: its value, or in three columns its derivatives too.
  void weigh(const Eigen::Vector2d& place, Eigen::Ref<Eigen::VectorXd> values) const;
  Eigen::MatrixX3d weighed(const Eigen::Vector2d& place) const;
  /// The samples' spectra less their smooth ones, at the bands, from sums of coefficients.
  BandVector atBands(const Eigen::Ref<const Eigen::VectorXd>& sums) const;

  Eigen::Matrix<double, 2, 3> m_differences;  ///< n q from a response
  SampleKernel m_kernel;  ///< of the samples, and where there is a Gaussian three rows more for its spectra
  std::optional<SkinGaussian> m_skin;
  Eigen::Index m_samples;
  WeightedSums m_coefficients;  ///< of the samples' kernels: nodes, then the response
  NodeBands m_bands;
  BandTriple m_smooth;  ///< smooth spectrum from a response, less what its nodes give
};

}  // namespace metamer::sip
