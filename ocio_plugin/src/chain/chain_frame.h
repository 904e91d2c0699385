// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "metamer/sip/spectral_transform.h"

namespace metamer::ocio {

/// The channels between which the chain tabulates a transform: wide ones, which white has in equal parts, so that all
/// that is seen has them well above zero on either side.
struct ChainFrame {
  Eigen::Matrix3d inputFromRgb;   ///< white: (1, 1, 1)
  Eigen::Matrix3d outputFromRgb;  ///< of what the transform makes of white: (1, 1, 1)
};

/// @param spec  what `transform` was made from
ChainFrame chainFrame(const sip::TransformSpec& spec, const sip::SpectralTransform& transform);

}  // namespace metamer::ocio
