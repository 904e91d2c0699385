// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "soft_bound/soft_bound_solver.h"

namespace metamer::sip {

/// Measured spectra interpolated over chromaticity (course notes, section 5.4): Delaunay triangles in the plane of
/// white-normalised chromaticity, linear on the cone over each, exact at the samples. White is a sample, so neutrals
/// stay on the perfect reflector. Samples that lie too near to one another for their spectra, or to white, keep what
/// they agree on (SettledPairs); those nearer than `kMergeDistance` are one, averaged, each scaled to the same weight.
///
/// What the interpolated spectrum deviates from the smooth one is the solver's prior; a colour outside the triangles
/// takes the deviation of the nearest chromaticity on their hull, its own sum times.
class DatasetScene {
 public:
  static constexpr double kMergeDistance = 1e-6;

  /// @param solver        gives weights and smooth spectra. Copied from, not kept.
  /// @param reflectances  B x n, at the band centres
  /// @throws spectral::InputError where the samples do not span a plane of chromaticities
  DatasetScene(const SoftBoundSolver& solver, const Eigen::MatrixXd& reflectances);

  /// Interpolated spectrum less the smooth one, for a white-normalised response. Zero where its sum is not positive.
  BandVector deviation(const Eigen::Vector3d& response) const;
  /// Of several responses, a column each.
  Eigen::MatrixXd deviations(const Eigen::Matrix3Xd& responses) const;

  struct Local {
    BandVector value;  ///< the deviation
    BandTriple slope;  ///< by the response
  };
  Local local(const Eigen::Vector3d& response) const;

 private:
  /// The deviation's piece round a response: linear in it.
  BandTriple piece(const Eigen::Vector3d& response) const;

  std::vector<std::array<int, 3>> m_triangles;
  std::vector<Eigen::Matrix3d> m_barycentric;  ///< sample weights from response
  std::vector<std::array<int, 2>> m_hull;      ///< edges that one triangle alone has
  Eigen::Matrix3Xd m_responses;                ///< unit-sum rays of the merged samples
  Eigen::MatrixXd m_deviations;                ///< B x n
};

}  // namespace metamer::sip
