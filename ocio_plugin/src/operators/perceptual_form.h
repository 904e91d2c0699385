// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <functional>

namespace metamer::ocio {

/// CIEDE2000 as a quadratic form: `d' F d` is about its square for a small deviation d.
///
/// Directions that it takes for free are given some cost, so that least squares do not run away along them.
/// @param difference  CIEDE2000 of a deviation, by its parts (spectral::difference2000)
/// @param step        how far to go to see it
Eigen::Matrix3d perceptualForm(const std::function<Eigen::Vector3d(const Eigen::Vector3d& deviation)>& difference,
                               double step);

}  // namespace metamer::ocio
