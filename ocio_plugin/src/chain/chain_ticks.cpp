// SPDX-License-Identifier: Apache-2.0
#include "chain/chain_ticks.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "chain/signed_log.h"
#include "operators/parallel.h"

namespace metamer::ocio {
namespace {

/// Probes along hue and along half the saturation from 0 to 0.5, to see where the transform bends. The sextants are
/// among them.
constexpr int kHues = 97;
constexpr int kSaturations = 65;
/// Part of the mean that is added to how much it bends, so that no stretch goes without ticks.
constexpr double kLeastPart = 0.2;
/// Part of the ticks that lie beyond a saturation of 1, and how near to 2 the last but one is: in steps of no more than
/// this factor.
constexpr double kBeyondPart = 0.18;
constexpr double kNearest = 1e-3;
constexpr double kLongestStep = 0.4;
/// Part of the ticks along the value that lie below zero.
constexpr double kNegativePart = 0.25;

/// Bending seen at even places along a coordinate.
using Profile = std::vector<double>;

/// How densely ticks should lie: a straight line's error grows with the square of its length.
Profile densityOf(const std::vector<Profile>& bends) {
  Profile density(bends.front().size(), 0.0);
  for (std::size_t k = 0; k < density.size(); ++k) {
    double sum = 0.0;
    for (const Profile& bend : bends) {
      sum += bend[k] * bend[k];
    }
    density[k] = std::pow(sum, 0.25);
  }
  Profile smooth = density;
  const auto last = static_cast<int>(density.size()) - 1;
  for (int k = 0; k <= last; ++k) {
    smooth[k] = 0.0;
    for (int near = -2; near <= 2; ++near) {
      smooth[k] += density[std::clamp(k + near, 0, last)] / 5.0;
    }
  }
  const double mean = std::accumulate(smooth.begin(), smooth.end(), 0.0) / static_cast<double>(smooth.size());
  for (double& value : smooth) {
    value += mean > 0.0 ? kLeastPart * mean : 1.0;
  }
  return smooth;
}

/// Cells shared out among stretches in proportion to their weights, at least one each.
std::vector<int> sharedOut(int cells, const std::vector<double>& weights) {
  std::vector<int> shares(weights.size(), 1);
  for (int left = cells - static_cast<int>(weights.size()); left > 0; --left) {
    std::size_t neediest = 0;
    for (std::size_t k = 1; k < weights.size(); ++k) {
      neediest = weights[k] / shares[k] > weights[neediest] / shares[neediest] ? k : neediest;
    }
    ++shares[neediest];
  }
  return shares;
}

/// Ticks over 0 ... 1 of a density, with some places held.
/// @param held  rising, from 0 to 1; fewer than there are ticks
std::vector<double> ticksOf(const Profile& density, const std::vector<double>& held, int count) {
  std::vector<double> share(density.size(), 0.0);
  for (std::size_t k = 1; k < density.size(); ++k) {
    share[k] = share[k - 1] + 0.5 * (density[k - 1] + density[k]);
  }
  const auto steps = static_cast<double>(density.size() - 1);
  const auto shareAt = [&](double place) {
    const auto below = std::min(static_cast<std::size_t>(place * steps), density.size() - 2);
    return share[below] + (place * steps - static_cast<double>(below)) * (share[below + 1] - share[below]);
  };
  const auto placeOf = [&](double wanted) {
    const auto above = std::clamp<std::ptrdiff_t>(std::upper_bound(share.begin(), share.end(), wanted) - share.begin(),
                                                  1, static_cast<std::ptrdiff_t>(share.size()) - 1);
    const double step = share[above] - share[above - 1];
    return (static_cast<double>(above - 1) + (wanted - share[above - 1]) / step) / steps;
  };
  std::vector<double> weights;
  for (std::size_t k = 1; k < held.size(); ++k) {
    weights.push_back(shareAt(held[k]) - shareAt(held[k - 1]));
  }
  const std::vector<int> cells = sharedOut(count - 1, weights);
  std::vector<double> ticks = {held.front()};
  for (std::size_t k = 0; k < cells.size(); ++k) {
    for (int cell = 1; cell < cells[k]; ++cell) {
      ticks.push_back(placeOf(shareAt(held[k]) + weights[k] * cell / cells[k]));
    }
    ticks.push_back(held[k + 1]);
  }
  return ticks;
}

/// On the curve's steps, one at least apart, with the ends where they are.
void round(std::vector<double>& ticks, int steps) {
  const auto count = static_cast<int>(ticks.size());
  int before = -1;
  for (int k = 0; k < count; ++k) {
    const int step = static_cast<int>(std::lround(ticks[k] * steps));
    before = std::clamp(step, before + 1, steps - (count - 1 - k));
    ticks[k] = static_cast<double>(before) / steps;
  }
}

/// The transform's bending along hue and along saturation, over the lights.
struct Bending {
  std::vector<Profile> alongHue = std::vector<Profile>(kSaturations, Profile(kHues, 0.0));
  std::vector<Profile> alongSaturation = std::vector<Profile>(kHues, Profile(kSaturations, 0.0));
};

Bending bendingOf(const ChainProbe& probe) {
  const auto pointAt = [](int hue, int saturation) {
    return Eigen::Vector2d(static_cast<double>(hue) / (kHues - 1), 0.5 * saturation / (kSaturations - 1));
  };
  std::vector<Eigen::Vector3d> logs(static_cast<std::size_t>(kHues) * kSaturations,
                                    Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN()));
  const auto at = [](int hue, int saturation) { return static_cast<std::size_t>(hue) * kSaturations + saturation; };
  parallelFor(kHues, [&](int hue) {
    std::vector<int> lights;
    std::vector<Eigen::Vector2d> points;
    for (int s = 0; s < kSaturations; ++s) {
      if (probe.isLight(pointAt(hue, s))) {
        lights.push_back(s);
        points.push_back(pointAt(hue, s));
      }
    }
    const std::vector<Eigen::Vector3d> ratios = probe.ratiosAt(points, 1.0);
    for (std::size_t k = 0; k < ratios.size(); ++k) {
      if (ratios[k].minCoeff() > 0.0) {
        logs[at(hue, lights[k])] = ratios[k].array().log() / std::log(2.0);
      }
    }
  });
  const auto bend = [&](int hue, int s, std::size_t before, std::size_t after) {
    const Eigen::Vector3d middle = 0.5 * (logs[before] + logs[after]);
    const double error = probe.difference(pointAt(hue, s), logs[at(hue, s)], middle);
    return std::isfinite(error) ? error : 0.0;
  };
  Bending bending;
  parallelFor(kHues, [&](int hue) {
    for (int s = 1; s < kSaturations; ++s) {
      // Along hue the ratios have corners at the sextants, which are ticks.
      if (hue % ((kHues - 1) / 6) != 0) {
        bending.alongHue[s][hue] = bend(hue, s, at(hue - 1, s), at(hue + 1, s));
      }
      if (s + 1 < kSaturations) {
        bending.alongSaturation[hue][s] = bend(hue, s, at(hue, s - 1), at(hue, s + 1));
      }
    }
  });
  return bending;
}

std::vector<double> hueTicks(const Bending& bending, int size) {
  std::vector<double> held = {0.0, 1.0};
  if (size > 6) {
    held = {0.0, 1.0 / 6.0, 2.0 / 6.0, 0.5, 4.0 / 6.0, 5.0 / 6.0, 1.0};
  }
  return ticksOf(densityOf(bending.alongHue), held, size);
}

std::vector<double> saturationTicks(const Bending& bending, int size) {
  const int beyond = std::max(1, static_cast<int>(std::lround(kBeyondPart * size)));
  std::vector<double> ticks = ticksOf(densityOf(bending.alongSaturation), {0.0, 1.0}, size - beyond);
  for (double& tick : ticks) {
    tick *= 0.5;
  }
  const double step = std::max(kLongestStep, std::pow(kNearest, 1.0 / std::max(1, beyond - 1)));
  for (int k = 1; k < beyond; ++k) {
    ticks.push_back(1.0 - 0.5 * std::pow(step, k));
  }
  ticks.push_back(1.0);
  return ticks;
}

/// Logarithms need no more than two nodes a side, one where the toe ends; more keep neighbours apart.
std::vector<double> valueTicks(int size) {
  const int below = std::max(1, static_cast<int>(kNegativePart * (size - 1)));
  const int above = size - 1 - below;
  const double toe = 0.5 * kSignedLogToe / kMostSignedLog;
  std::vector<double> ticks;
  const auto side = [&](int count) {
    std::vector<double> from;
    for (int k = 0; k < count; ++k) {
      from.push_back(count == 1 ? 0.5 : toe + (0.5 - toe) * k / (count - 1));
    }
    return from;
  };
  for (const double from : side(below)) {
    ticks.insert(ticks.begin(), 0.5 - from);
  }
  ticks.push_back(0.5);
  for (const double from : side(above)) {
    ticks.push_back(0.5 + from);
  }
  return ticks;
}

}  // namespace

ChainTicks placeTicks(const ChainProbe& probe, int size) {
  const Bending bending = bendingOf(probe);
  ChainTicks ticks = {hueTicks(bending, size), saturationTicks(bending, size), valueTicks(size)};
  for (auto& along : ticks) {
    round(along, tickSteps(size));
  }
  return ticks;
}

}  // namespace metamer::ocio
