// SPDX-License-Identifier: Apache-2.0
#include "chain/chromaticity_ticks.h"

#include <algorithm>
#include <cmath>

#include "chain/chromaticity_probe.h"
#include "operators/parallel.h"

namespace metamer::ocio {
namespace {

/// Power mean over a strip of the bending in it; and the least density of ticks against the mean.
constexpr double kBendingPower = 1.5;
constexpr double kLeastDensity = 0.2;
/// Density follows a strip's error by this power, the error being held within a factor of the mean.
constexpr double kMovePower = 0.15;
constexpr double kMostOfMean = 20.0;

/// Ticks spread so that a cumulated density grows by equal steps on either side of white, which gets a tick.
/// @param at       rising positions 0 ... 1
/// @param density  between a position and the next
std::vector<double> spreadTicks(const std::vector<double>& at, const std::vector<double>& density, double white,
                                int count) {
  std::vector<double> sum(at.size(), 0.0);
  for (std::size_t k = 1; k < at.size(); ++k) {
    sum[k] = sum[k - 1] + density[k - 1] * (at[k] - at[k - 1]);
  }
  const auto interpolate = [](const std::vector<double>& x, const std::vector<double>& y, double value) {
    const auto above = std::clamp<std::ptrdiff_t>(std::upper_bound(x.begin(), x.end(), value) - x.begin(), 1,
                                                  static_cast<std::ptrdiff_t>(x.size()) - 1);
    const double t = (value - x[above - 1]) / (x[above] - x[above - 1]);
    return y[above - 1] + t * (y[above] - y[above - 1]);
  };
  const double atWhite = interpolate(at, sum, white);
  const int below = std::clamp(static_cast<int>(std::lround((count - 1) * atWhite / sum.back())), 1, count - 2);
  const double steps = tickSteps(count);
  std::vector<double> ticks;
  for (int k = 0; k < count; ++k) {
    const double target =
        k <= below ? atWhite * k / below : atWhite + (sum.back() - atWhite) * (k - below) / (count - 1 - below);
    // On the curve's entries, so that a look-up in it bends nowhere else.
    double tick = std::round(interpolate(sum, at, target) * steps) / steps;
    tick = std::max(tick, ticks.empty() ? 0.0 : ticks.back() + 1.0 / steps);
    ticks.push_back(std::min(tick, 1.0 - static_cast<double>(count - 1 - k) / steps));
  }
  return ticks;
}

}  // namespace

PlacedTicks placeTicks(const PlaneTicks& probes, const ChromaticityPlane& plane,
                       const sip::SpectralTransform& transform, int count) {
  struct Probe {
    bool feasible = false;
    Eigen::Vector3d value;
    Eigen::Matrix3d metric;
  };
  const ChromaticityProbe asked(plane, transform);
  const std::size_t rows = probes[0].size();
  const std::size_t columns = probes[1].size();
  std::vector<Probe> grid(rows * columns);
  parallelFor(static_cast<int>(rows), [&](int i) {
    for (std::size_t j = 0; j < columns; ++j) {
      const auto answer = asked.askFeasible({probes[0][i], probes[1][j]});
      if (answer.isUsable) {
        Probe& probe = grid[static_cast<std::size_t>(i) * columns + j];
        probe.value = answer.value;
        probe.metric = asked.metric(answer);
        probe.feasible = probe.metric.allFinite();
      }
    }
  });
  PlacedTicks result;
  for (int axis = 0; axis < 2; ++axis) {
    const auto& at = probes[axis];
    const std::size_t across = probes[1 - axis].size();
    const auto probe = [&](std::size_t along, std::size_t other) -> const Probe& {
      return axis == 0 ? grid[along * columns + other] : grid[other * columns + along];
    };
    std::vector<double> density(at.size() - 1, 0.0);
    for (std::size_t k = 1; k + 1 < at.size(); ++k) {
      double bending = 0.0;
      for (std::size_t other = 0; other < across; ++other) {
        const Probe& before = probe(k - 1, other);
        const Probe& here = probe(k, other);
        const Probe& after = probe(k + 1, other);
        if (before.feasible && here.feasible && after.feasible) {
          const double left = at[k] - at[k - 1];
          const double right = at[k + 1] - at[k];
          const Eigen::Vector3d second =
              2.0 / (left + right) * ((after.value - here.value) / right - (here.value - before.value) / left);
          bending += std::pow(std::max(0.0, second.dot(here.metric * second)), 0.5 * kBendingPower);
        }
      }
      const double needed = std::pow(bending / static_cast<double>(across), 0.5 / kBendingPower);
      density[k - 1] = std::max(density[k - 1], needed);
      density[k] = std::max(density[k], needed);
    }
    // The outermost strips have no probe beyond them to bend against.
    const auto isBent = [](double value) { return value > 0.0; };
    const auto first = std::find_if(density.begin(), density.end(), isBent);
    if (first != density.end()) {
      std::fill(density.begin(), first, *first);
      const auto last = std::find_if(density.rbegin(), density.rend(), isBent);
      std::fill(density.rbegin(), last, *last);
    }
    double mean = 0.0;
    for (std::size_t k = 0; k + 1 < at.size(); ++k) {
      mean += density[k] * (at[k + 1] - at[k]);
    }
    double total = 0.0;
    for (std::size_t k = 0; k + 1 < at.size(); ++k) {
      density[k] = std::max(density[k], kLeastDensity * mean) + 1e-12;
      total += density[k] * (at[k + 1] - at[k]);
    }
    result.ticks[axis] = spreadTicks(at, density, plane.white[axis], count);
    result.bending += total * total;
  }
  return result;
}

PlaneTicks movedTicks(const PlaneTicks& ticks, const PlaneTicks& strips, const Eigen::Vector2d& white) {
  PlaneTicks moved;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const auto& along = ticks[axis];
    const auto& error = strips[axis];
    double mean = 0.0;
    for (const double value : error) {
      mean += value / static_cast<double>(error.size());
    }
    std::vector<double> density;
    for (std::size_t k = 0; k < error.size(); ++k) {
      // Softened by its neighbours.
      double sum = error[k];
      double weight = 1.0;
      for (const std::size_t other : {k - 1, k + 1}) {
        if (other < error.size()) {
          sum += 0.5 * error[other];
          weight += 0.5;
        }
      }
      const double part = mean > 0.0 ? std::clamp(sum / weight / mean, 1.0 / kMostOfMean, kMostOfMean) : 1.0;
      density.push_back(std::pow(part, kMovePower) / (along[k + 1] - along[k]));
    }
    moved[axis] = spreadTicks(along, density, white[static_cast<Eigen::Index>(axis)], static_cast<int>(along.size()));
  }
  return moved;
}

std::vector<double> evenTicks(int count) {
  std::vector<double> ticks;
  ticks.reserve(static_cast<std::size_t>(count));
  for (int k = 0; k < count; ++k) {
    ticks.push_back(static_cast<double>(k) / (count - 1));
  }
  return ticks;
}

std::vector<double> subdivided(const std::vector<double>& ticks, int parts) {
  std::vector<double> result;
  for (std::size_t k = 0; k + 1 < ticks.size(); ++k) {
    for (int part = 0; part < parts; ++part) {
      result.push_back(ticks[k] + (ticks[k + 1] - ticks[k]) * part / parts);
    }
  }
  result.push_back(ticks.back());
  return result;
}

}  // namespace metamer::ocio
