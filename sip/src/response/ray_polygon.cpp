// SPDX-License-Identifier: Apache-2.0
#include "response/ray_polygon.h"

namespace metamer::sip {

std::vector<Eigen::Vector3d> clipRays(const std::vector<Eigen::Vector3d>& rays, const Eigen::Vector3d& normal) {
  std::vector<Eigen::Vector3d> clipped;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Eigen::Vector3d& from = rays[i];
    const Eigen::Vector3d& to = rays[(i + 1) % rays.size()];
    const double a = normal.dot(from);
    const double b = normal.dot(to);
    if (a >= 0.0) {
      clipped.push_back(from);
    }
    if ((a > 0.0 && b < 0.0) || (a < 0.0 && b > 0.0)) {
      clipped.push_back((a * to - b * from) / (a - b));
    }
  }
  return clipped;
}

}  // namespace metamer::sip
