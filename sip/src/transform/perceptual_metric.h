// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "metamer/spectral/rgb_space.h"

namespace metamer::sip {

/// CIEDE2000 between neighbouring colours: its limit for small differences, a quadratic form. Steers refinement; the
/// error protocol measures the result with the full formula.
class PerceptualMetric {
 public:
  explicit PerceptualMetric(const spectral::RgbSpace& space);

  /// Matrix G: |G * error| is the CIEDE2000 between `output + error` and `output` for a small error, both scaled by the
  /// exposure that puts `input` at Y = 0.18. Luminance under a fiftieth of the largest tristimulus counts as that.
  /// Under a hundredth there is no light but deep violet, and no CIEDE2000 to speak of: an error as large as the
  /// largest tristimulus then counts as 4.
  Eigen::Matrix3d at(const Eigen::Vector3d& input, const Eigen::Vector3d& output) const;

  /// The same for a colour and errors that are XYZ over the working white, at their own exposure.
  static Eigen::Matrix3d atRelative(const Eigen::Vector3d& colour);

 private:
  Eigen::Matrix3d m_relativeFromRgb;  ///< XYZ over white
};

}  // namespace metamer::sip
