// SPDX-License-Identifier: Apache-2.0
#include "pairs/cover.h"

#include <cmath>

namespace metamer::sip {

Cover::Share Cover::at(const Eigen::Vector2d& place) const {
  double left = 1.0;
  Eigen::Vector2d leftSlope = Eigen::Vector2d::Zero();
  for (Eigen::Index i = 0; i < m_places.cols(); ++i) {
    const Eigen::Vector2d away = place - m_places.col(i);
    const double squared = away.squaredNorm();
    if (squared >= m_radii[i] * m_radii[i]) {
      continue;
    }
    const double r = std::sqrt(squared) / m_radii[i];
    const double rest = 1.0 - r;
    const double bump = rest * rest * rest * rest * (4.0 * r + 1.0);
    // The function's derivative is -20 r (1 - r)^3, so that its slope has no corner at the place.
    const Eigen::Vector2d bumpSlope = -20.0 * rest * rest * rest / (m_radii[i] * m_radii[i]) * away;
    leftSlope = (1.0 - bump) * leftSlope - left * bumpSlope;
    left *= 1.0 - bump;
  }
  return {1.0 - left, -leftSlope};
}

}  // namespace metamer::sip
