// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "metamer/sip/pipeline.h"
#include "metamer/sip/spectral_transform.h"

namespace metamer::sip {

/// Both sides of the dual pipeline (course notes, sections 5.2 and 5.6) and the matrices between their spaces.
///
/// - response: the input side's, white-normalised: the perfect reflector is (1, 1, 1);
/// - relative: XYZ of the working space over its white, as fully adapted: plain adaptation leaves a colour as it is.
///   Of a picture that was balanced it is the picture itself;
/// - output response: PreparedPipeline's.
struct Sides {
  PreparedPipeline input;
  PreparedPipeline output;
  bool equal = false;  ///< both sides are the same, and so is exposure

  Eigen::Matrix3d responseFromRgb;
  Eigen::Matrix3d relativeFromRgb;
  Eigen::Matrix3d relativeFromResponse;
  Eigen::Matrix3d relativeFromOutputResponse;
  /// Of a relative colour, the cones that the output light leaves dark: they are as plain adaptation has them.
  Eigen::Matrix3d unseen;
  Eigen::Matrix3d rgbFromRelative;        ///< with the degree of adaptation and the exposure
  Eigen::Matrix3d rgbFromOutputResponse;  ///< likewise

  /// White-normalised response from reflectance, 3 x bandCount.
  Eigen::Matrix3Xd inputWeights(int bandCount) const;
  /// Relative XYZ from reflectance, 3 x bandCount.
  Eigen::Matrix3Xd relativeWeights(int bandCount) const;
};

/// @throws spectral::InputError where the specification has no meaning (no light, a white the CAT cannot reach, an
///         adaptation outside 0 ... 1)
Sides prepareSides(const TransformSpec& spec);

}  // namespace metamer::sip
