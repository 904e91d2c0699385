// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>

namespace metamer::spectral {

/// weights[0] curves[0] + weights[1] curves[1] + weights[2] curves[2], added up in that order.
/// @param spectrum  gets as many numbers as each curve has
void mixCurves(const std::array<const Eigen::VectorXd*, 3>& curves, const Eigen::Vector3d& weights, double* spectrum);

}  // namespace metamer::spectral
