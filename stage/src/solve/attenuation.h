// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "metamer/stage/wall_intervals.h"

namespace metamer::stage {

/// Q of a noisy capture without what noise in P takes from it: least squares divide by P Pᵀ, which noise makes larger,
/// so Q comes out too small, the more so the weaker a colour is on the chart (Fuller 1987, errors in variables).
/// @param noise  of the chart's values under the channels
/// @param times  how often that noise lies on the capture, in variances: 1 captured, 2 drawn once more on top
Eigen::Matrix3d withoutAttenuation(const WallCapture& capture, const WallOptions& walls, const WallSolution& solution,
                                   const CaptureNoise& noise, double times);

}  // namespace metamer::stage
