// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "metamer/sip/homogeneous_map.h"

namespace metamer::sip {

/// Sets the half-spaces of a map's linear cone: a polygon inscribed in the transform's, of few corners.
/// @param cubeFromRgb  where the polygon is looked at flat
void addLinearCone(const SpectralTransform& transform, const Eigen::Matrix3d& cubeFromRgb, HomogeneousMap& map);

}  // namespace metamer::sip
