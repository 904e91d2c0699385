// SPDX-License-Identifier: Apache-2.0
#include "map/linear_cone.h"

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <vector>

namespace metamer::sip {

namespace {

/// Inscribed polygon with at most `most` corners: drops the corner that costs the least area, again and again.
std::vector<Eigen::Vector3d> inscribedPolygon(std::vector<Eigen::Vector3d> corners, const Eigen::Matrix3d& cubeFromRgb,
                                              std::size_t most) {
  const auto flat = [&](const Eigen::Vector3d& ray) {
    const Eigen::Vector3d p = cubeFromRgb * ray;
    return Eigen::Vector2d(p.head<2>() / p.z());
  };
  while (corners.size() > most) {
    std::size_t least = 0;
    double leastArea = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Eigen::Vector2d a = flat(corners[(i + corners.size() - 1) % corners.size()]);
      const Eigen::Vector2d b = flat(corners[i]);
      const Eigen::Vector2d c = flat(corners[(i + 1) % corners.size()]);
      const Eigen::Vector2d ab = b - a;
      const Eigen::Vector2d ac = c - a;
      const double area = std::abs(ab.x() * ac.y() - ab.y() * ac.x());
      if (area < leastArea) {
        leastArea = area;
        least = i;
      }
    }
    corners.erase(corners.begin() + static_cast<std::ptrdiff_t>(least));
  }
  return corners;
}

}  // namespace

void addLinearCone(const SpectralTransform& transform, const Eigen::Matrix3d& cubeFromRgb, HomogeneousMap& map) {
  const auto corners = inscribedPolygon(transform.linearConeCorners(), cubeFromRgb, HomogeneousMap::kMostLinearNormals);
  if (corners.size() < 3) {
    return;
  }
  map.linearNormalCount = static_cast<int>(corners.size());
  for (std::size_t i = 0; i < corners.size(); ++i) {
    Eigen::Vector3d normal = corners[i].cross(corners[(i + 1) % corners.size()]).normalized();
    if (normal.sum() < 0.0) {  // neutral (1, 1, 1) is inside
      normal = -normal;
    }
    Eigen::Map<Eigen::Vector3f>(map.linearNormals.data() + 3 * i) = normal.cast<float>();
  }
}

}  // namespace metamer::sip
