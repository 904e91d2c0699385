// SPDX-License-Identifier: Apache-2.0
#include "map/known_points.h"

namespace metamer::sip {

std::vector<KnownPoint> knownPoints(const SpectralTransform& transform, const Eigen::Matrix3d& cubeFromRgb,
                                    const PerceptualMetric& metric) {
  std::vector<SpectralTransform::Point> solved;
  std::vector<KnownPoint> points;
  for (const Eigen::Vector3d& rgb : transform.knownColours()) {
    const Eigen::Vector3d cube = cubeFromRgb * rgb;
    if (cube.z() > 0.0 && cube.z() >= cube.cwiseAbs().maxCoeff()) {
      points.emplace_back().place = 0.5 * (cube.head<2>() / cube.z() + Eigen::Vector2d::Ones());
      solved.emplace_back().rgb = rgb / cube.z();
    }
  }
  transform.solve(solved);
  for (std::size_t k = 0; k < points.size(); ++k) {
    points[k].value = solved[k].value;
    points[k].metric = metric.at(solved[k].rgb, solved[k].value);
  }
  return points;
}

}  // namespace metamer::sip
