// SPDX-License-Identifier: Apache-2.0
#include "transform/limiter.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace metamer::sip {

namespace {

using Eigen::Index;
using Eigen::RowVector3d;
using Eigen::Vector3d;

/// Of the surfaces, this share is meant to be left alone.
constexpr double kLeftAlone = 0.98;
/// X and Z count this part of themselves as a colour's size.
constexpr double kOwnSize = 1.0 / 8.0;

/// A number with its derivative by a colour.
struct Graded {
  double value;
  RowVector3d slope;
};

Graded largerOf(const Graded& a, const Graded& b) {
  return a.value >= b.value ? a : b;
}

Graded luminanceSize(const Vector3d& colour) {
  return colour.y() > 0.0 ? Graded{colour.y(), RowVector3d::UnitY()} : Graded{0.0, RowVector3d::Zero()};
}

Graded sideSize(const Vector3d& colour) {
  Graded size = luminanceSize(colour);
  for (const Index k : {0, 2}) {
    size = largerOf({kOwnSize * std::abs(colour[k]), std::copysign(kOwnSize, colour[k]) * RowVector3d::Unit(k)}, size);
  }
  return size;
}

/// m with its derivative by d.
Graded taken(const Vector3d& difference, const Limiter::Reach& reach) {
  const std::array<double, 3> reaches = {reach.aside, difference.y() > 0.0 ? reach.up : reach.down, reach.aside};
  Graded most{0.0, RowVector3d::Zero()};
  for (Index k = 0; k < 3; ++k) {
    const double each = reaches[static_cast<std::size_t>(k)];
    most = largerOf(most,
                    {std::abs(difference[k]) / each, std::copysign(1.0 / each, difference[k]) * RowVector3d::Unit(k)});
  }
  return most;
}

struct Share {
  double value = 1.0;
  RowVector3d byColour = RowVector3d::Zero();
  RowVector3d byDifference = RowVector3d::Zero();
};

Share shareOf(const Graded& size, const Graded& most) {
  if (most.value <= 0.5 * size.value) {
    return {};
  }
  const double s = size.value / most.value;
  const double slope = (1.0 - 0.5 * s) / most.value;
  return {s - 0.25 * s * s, slope * size.slope, -slope * s * most.slope};
}

/// What channel k may lose of itself; all of it where it gains.
Share shareOfLoss(Index k, const Vector3d& colour, const Vector3d& difference) {
  if (difference[k] >= 0.0) {
    return {};
  }
  const Graded own = colour[k] > 0.0 ? Graded{Limiter::kMostLoss * colour[k], Limiter::kMostLoss * RowVector3d::Unit(k)}
                                     : Graded{0.0, RowVector3d::Zero()};
  return shareOf(own, {-difference[k], -RowVector3d::Unit(k)});
}

/// The value that this share of all does not exceed, linear between ranks.
double percentile(std::vector<double> values, double share) {
  if (values.empty()) {
    return 0.0;
  }
  std::sort(values.begin(), values.end());
  const double rank = share * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(rank);
  const std::size_t above = std::min(below + 1, values.size() - 1);
  return values[below] + (rank - static_cast<double>(below)) * (values[above] - values[below]);
}

}  // namespace

Limiter::Reach Limiter::reachFor(const std::vector<Vector3d>& colours, const std::vector<Vector3d>& differences) {
  std::vector<double> up;
  std::vector<double> down;
  std::vector<double> aside;
  for (std::size_t i = 0; i < colours.size(); ++i) {
    const double luminance = colours[i].y();
    if (luminance > 0.0) {
      const Vector3d& d = differences[i];
      up.push_back(std::max(d.y() / luminance, 0.0));
      down.push_back(std::max(-d.y() / luminance, 0.0));
      aside.push_back(std::max(std::abs(d.x()), std::abs(d.z())) / sideSize(colours[i]).value);
    }
  }
  const Reach least;
  const auto raised = [](std::vector<double> values, double from, double to) {
    return std::clamp(2.0 * percentile(std::move(values), kLeftAlone), from, to);
  };
  return {raised(std::move(up), least.up, kMostReach.up), raised(std::move(down), least.down, kMostReach.down),
          raised(std::move(aside), least.aside, kMostReach.aside)};
}

bool Limiter::keeps(const Vector3d& colour, const Vector3d& difference) const {
  const auto losesLittle = [&](Index k) {
    return difference[k] >= 0.0 || -difference[k] <= 0.5 * kMostLoss * std::max(colour[k], 0.0);
  };
  return taken(difference, m_reach).value <= 0.5 * luminanceSize(colour).value && losesLittle(0) && losesLittle(2);
}

Limiter::Limited Limiter::limited(const Vector3d& colour, const Vector3d& difference) const {
  const Graded most = taken(difference, m_reach);
  const Share luminance = shareOf(luminanceSize(colour), most);
  const Share sides = shareOf(sideSize(colour), most);
  Limited limited{colour, Eigen::Matrix3d::Identity(), Eigen::Matrix3d::Zero()};
  for (Index k = 0; k < 3; ++k) {
    Share own = k == 1 ? luminance : sides;
    if (k != 1) {
      const Share loss = shareOfLoss(k, colour, difference);
      own = loss.value < own.value ? loss : own;
    }
    limited.value[k] += own.value * difference[k];
    limited.byColour.row(k) += difference[k] * own.byColour;
    limited.byDifference.row(k) = difference[k] * own.byDifference;
    limited.byDifference(k, k) += own.value;
  }
  return limited;
}

Vector3d Limiter::apply(const Vector3d& colour, const Vector3d& difference) const {
  return limited(colour, difference).value;
}

}  // namespace metamer::sip
