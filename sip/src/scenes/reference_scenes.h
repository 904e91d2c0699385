// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "metamer/sip/feasible_cone.h"

namespace metamer::sip {

/// Measured spectra interpolated over chromaticity (course notes, section 5.4): Delaunay triangles in the plane of
/// white-normalised chromaticity, linear on the cone over each. White is a sample, so neutrals stay on the perfect
/// reflector. Samples nearer than `kMergeDistance` are averaged, each scaled to the same weight.
class DatasetScene {
 public:
  static constexpr double kMergeDistance = 2e-3;

  /// @param weights      3 x B, white-normalised input weights
  /// @param reflectances B x n, at the band centres
  DatasetScene(const Eigen::Matrix3Xd& weights, const Eigen::MatrixXd& reflectances);

  /// The cone over the samples' hull.
  const FeasibleCone& cone() const { return *m_cone; }

  struct Piece {
    int triangle = -1;
    Eigen::MatrixX3d spectrumFromResponse;  ///< B x 3
  };
  /// The triangle of a colour inside cone().
  Piece locate(const Eigen::Vector3d& response) const;

  int triangleCount() const { return static_cast<int>(m_triangles.size()); }

 private:
  Eigen::Matrix3Xd m_responses;  ///< unit-sum rays of the merged samples
  Eigen::MatrixXd m_spectra;     ///< B x n, scaled likewise
  std::vector<std::array<int, 3>> m_triangles;
  std::vector<Eigen::Matrix3d> m_barycentric;  ///< sample weights from response
  std::optional<FeasibleCone> m_cone;
};

/// The blend of measured spectra near a chromaticity: what the smooth spectrum deviates from.
///
/// P(c) = strength * s(c) * sum_i w_i (R_i / s_i) / (w_0 + sum_i w_i), w_i a Gaussian of the CIE xy distance and s the
/// sum of the white-normalised response; w_0 is the weight of one sample three radii away, so that the blend fades to
/// nothing beyond.
class PriorScene {
 public:
  PriorScene(const Eigen::Matrix3Xd& weights, const Eigen::Matrix3d& xyzFromNormalised,
             const Eigen::MatrixXd& reflectances, double strength, double radius);

  /// P, B values, for a white-normalised response with a positive sum.
  Eigen::VectorXd blend(const Eigen::Vector3d& response) const;

 private:
  Eigen::Matrix3d m_xyzFromNormalised;
  std::vector<Eigen::Vector2d> m_chromaticities;
  Eigen::MatrixXd m_spectra;  ///< B x n, R_i / s_i
  double m_strength;
  double m_radius;
};

}  // namespace metamer::sip
