// SPDX-License-Identifier: Apache-2.0
#include "transform/limiter.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace metamer::sip {

namespace {

/// Of the surfaces, this share is meant to be left alone.
constexpr double kLeftAlone = 0.98;

/// The value that this share of all does not exceed.
double percentile(std::vector<double> values, double share) {
  if (values.empty()) {
    return 0.0;
  }
  const auto rank = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + rank, values.end());
  return values[static_cast<std::size_t>(rank)];
}

}  // namespace

Limiter::Reach Limiter::reachFor(const std::vector<Eigen::Vector3d>& colours,
                                 const std::vector<Eigen::Vector3d>& differences) {
  std::vector<double> up;
  std::vector<double> down;
  std::vector<double> aside;
  for (std::size_t i = 0; i < colours.size(); ++i) {
    const double size = colours[i].y();
    if (size > 0.0) {
      const Eigen::Vector3d ratio = differences[i] / size;
      up.push_back(std::max(ratio.y(), 0.0));
      down.push_back(std::max(-ratio.y(), 0.0));
      aside.push_back(std::max(std::abs(ratio.x()), std::abs(ratio.z())));
    }
  }
  const Reach least;
  const auto raised = [](std::vector<double> taken, double from, double to) {
    return std::clamp(2.0 * percentile(std::move(taken), kLeftAlone), from, to);
  };
  return {raised(std::move(up), least.up, kMostReach.up), raised(std::move(down), least.down, kMostReach.down),
          raised(std::move(aside), least.aside, kMostReach.aside)};
}

Limiter::Share Limiter::share(const Eigen::Vector3d& colour, const Eigen::Vector3d& difference) const {
  const double size = std::max(colour.y(), 0.0);
  // Each of the four takes `difference[component] * factor` of the size.
  const std::array<std::pair<Eigen::Index, double>, 3> ways = {
      std::pair<Eigen::Index, double>{1, difference.y() > 0.0 ? 1.0 / m_reach.up : -1.0 / m_reach.down},
      std::pair<Eigen::Index, double>{0, difference.x() > 0.0 ? 1.0 / m_reach.aside : -1.0 / m_reach.aside},
      std::pair<Eigen::Index, double>{2, difference.z() > 0.0 ? 1.0 / m_reach.aside : -1.0 / m_reach.aside}};
  double most = 0.0;
  std::pair<Eigen::Index, double> tightest = ways[0];
  for (const auto& way : ways) {
    const double taken = difference[way.first] * way.second;
    if (taken > most) {
      most = taken;
      tightest = way;
    }
  }
  if (most <= 0.5 * size) {
    return {1.0, Eigen::RowVector3d::Zero(), Eigen::RowVector3d::Zero()};
  }
  const double s = size / most;
  Share share{s - 0.25 * s * s, Eigen::RowVector3d::Zero(), Eigen::RowVector3d::Zero()};
  const double slope = (1.0 - 0.5 * s) / most;
  if (size > 0.0) {
    share.slope.y() = slope;
  }
  share.slopeByDifference[tightest.first] = -slope * s * tightest.second;
  return share;
}

}  // namespace metamer::sip
