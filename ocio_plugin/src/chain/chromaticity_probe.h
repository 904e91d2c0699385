// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "chain/chromaticity_plane.h"

namespace metamer::ocio {

/// Asks a transform about points of its plane of chromaticity, and judges what a table gives there.
class ChromaticityProbe {
 public:
  ChromaticityProbe(const ChromaticityPlane& plane, const sip::SpectralTransform& transform);

  /// The colour at a point of the plane, at the error protocol's luminance.
  Eigen::Vector3d colourAt(const Eigen::Vector2d& point) const;

  struct Answer {
    Eigen::Vector3d in;
    Eigen::Vector3d out;
    Eigen::Vector3d value;  ///< what the table should hold: output (a, b), and output over input amount in stops
    double amount = 0;      ///< the input's
    bool isFeasible = false;
    bool isUsable = false;  ///< whether there is such a value
  };
  Answer ask(const Eigen::Vector2d& point) const;
  /// The same where only colours that reflectances can make are of interest: others are left unsolved.
  Answer askFeasible(const Eigen::Vector2d& point) const;

  /// CIEDE2000 as a quadratic form of small deviations of the value.
  Eigen::Matrix3d metric(const Answer& answer) const;
  /// CIEDE2000 in full of another value in place of the answer's.
  double error(const Answer& answer, const Eigen::Vector3d& value) const;

  /// Points close to the border of what reflectances can make, as the error protocol has them: 97 % of the way from
  /// white, at even angles of the CIE xy diagram.
  std::vector<Eigen::Vector2d> ring(int count) const;

  /// Area in the CIE xy diagram of a small area of the plane.
  double xyArea(const Eigen::Vector2d& point, double area) const;

 private:
  Answer answered(const Eigen::Vector3d& in, bool isFeasible) const;

  const ChromaticityPlane& m_plane;
  const sip::SpectralTransform& m_transform;
  Eigen::Matrix3d m_xyzFromRgb;
  Eigen::Vector3d m_white;
};

}  // namespace metamer::ocio
