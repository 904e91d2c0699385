// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

namespace metamer::sip {

/// Delaunay triangles of distinct points in the plane (Bowyer 1981, Watson 1981), corners counter-clockwise,
/// for the few hundred points of a sample set: O(n^2). Fewer than three points or all collinear: none.
std::vector<std::array<int, 3>> delaunayTriangles(const std::vector<Eigen::Vector2d>& points);

}  // namespace metamer::sip
