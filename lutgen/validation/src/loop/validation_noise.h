// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

namespace metamer::validation {

/// Half the 95 % interval, in CIEDE2000 about a colour, of the mean of differences in CIE Lab, along the direction in
/// which they scatter most. Student's t over the differences' number less one.
/// @param differences  at least 3
double intervalOfMean(const Eigen::Vector3d& lab, const std::vector<Eigen::Vector3d>& differences);

}  // namespace metamer::validation
