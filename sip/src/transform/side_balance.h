// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "metamer/sip/pipeline.h"
#include "metamer/sip/spectral_transform.h"

namespace metamer::sip {

/// One side's picture as it is balanced to the working space's white.
struct SideBalance {
  /// XYZ of the working space over its white, from PreparedPipeline's response: white goes to (1, 1, 1), but for cones
  /// that the light leaves dark, where all goes to 0.
  Eigen::Matrix3d relativeFromResponse;
  /// Of a relative colour, what such dark cones would have.
  Eigen::Matrix3d unseen;
  bool hasDarkCones = false;
  std::string cones;  ///< the balance's name, for messages
};

/// How the specification says a side's picture is balanced (Balance). One that was not balanced is taken as its
/// chromatic adaptation would balance it.
/// @throws spectral::InputError where a camera's daylight gives it nothing, or training is too short for its matrix
SideBalance balanceOf(const TransformSpec& spec, const Pipeline& pipeline, const PreparedPipeline& prepared);

}  // namespace metamer::sip
