// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <functional>

namespace metamer::ocio {

/// CIEDE2000 as a quadratic form: `d' F d` is about its square for a small deviation d.
///
/// The difference is not quite a quadratic form. What is left of the mixed terms' inconsistency is taken out, so that
/// least squares do not run away along a direction that seems to cost nothing.
/// @param difference  CIEDE2000 of a deviation
/// @param step        how far to go to see it
Eigen::Matrix3d perceptualForm(const std::function<double(const Eigen::Vector3d& deviation)>& difference, double step);

}  // namespace metamer::ocio
