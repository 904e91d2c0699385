// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

namespace metamer::sip {

/// Clips a convex polygon in the plane of chromaticity, given by rays in order, to the half-space normal . ray >= 0
/// (Sutherland and Hodgman's step). Empty where nothing is left.
std::vector<Eigen::Vector3d> clipRays(const std::vector<Eigen::Vector3d>& rays, const Eigen::Vector3d& normal);

}  // namespace metamer::sip
