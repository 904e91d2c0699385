// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

namespace metamer::sip {

/// The tristimuli that reflectances can make: the convex cone over the bands' weights.
///
/// It is polyhedral: a polygon in the plane of chromaticity. It is drawn in by `kMargin` of the way to white, so that
/// every problem inside it is safely solvable. Coordinates are white-normalised:
/// white is (1, 1, 1).
class FeasibleCone {
 public:
  /// How far the polygon is drawn in toward white.
  static constexpr double kMargin = 1e-3;

  /// @param rays   3 x n generators, white-normalised
  /// @param basis  3 x r orthonormal columns that span the cone (r = 1, 2 or 3)
  FeasibleCone(const Eigen::Matrix3Xd& rays, const Eigen::Matrix3Xd& basis);

  /// What this cone shares with another of the same basis. Both hold white.
  FeasibleCone within(const FeasibleCone& other) const;

  /// Euclidean projection: the nearest point of the cone, with the linear map that takes all points of the same piece
  /// there. Continuous, homogeneous of degree one, never longer than the point itself.
  struct Projection {
    Eigen::Vector3d point;
    Eigen::Matrix3d matrix;  ///< projector of this piece; point = matrix * given
    int piece = 0;           ///< 0 inside; facets, rays and the apex have their own numbers
  };
  Projection project(const Eigen::Vector3d& colour) const;

  /// Corners of the polygon, unit rays in order round white; two for a flat cone, one for a half-line.
  const std::vector<Eigen::Vector3d>& corners() const { return m_corners; }
  /// Number of independent directions: 3 for ordinary lights.
  int rank() const { return static_cast<int>(m_basis.cols()); }
  bool contains(const Eigen::Vector3d& colour) const;

 private:
  void setNormals();
  /// Of a ray in the plane of a flat cone, from white.
  double angleFromWhite(const Eigen::Vector3d& ray) const;

  Eigen::Matrix3Xd m_basis;
  std::vector<Eigen::Vector3d> m_corners;
  std::vector<Eigen::Vector3d> m_normals;  ///< inward, of the facet from corner i to i + 1
};

/// Of the average generator's weight: a generator as faint as this is half way to white in `litGenerators`.
inline constexpr double kFaintGenerator = 0.01;

/// Generators by their chromaticities, of which the faint are drawn in toward white: w times as heavy as
/// `kFaintGenerator`, by 1 / (1 + w^4) of the way.
///
/// A cone of bare chromaticities reaches into the ends of the visible range and the dark between a lamp's lines, where
/// a reflectance must be thousands of times brighter than white, and a transform amplifies as much what lies just
/// outside.
/// @param rays  3 x n, white-normalised; those without weight are left out
Eigen::Matrix3Xd litGenerators(const Eigen::Matrix3Xd& rays);

}  // namespace metamer::sip
