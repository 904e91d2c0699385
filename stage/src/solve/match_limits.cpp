// SPDX-License-Identifier: Apache-2.0
#include "metamer/stage/match_limits.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "metamer/spectral/argument_checks.h"
#include "metamer/spectral/formatted.h"
#include "metamer/spectral/input_error.h"
#include "metamer/stage/chart_difference.h"

namespace metamer::stage {
namespace {

using spectral::InputError;

constexpr double kInfinite = std::numeric_limits<double>::infinity();
/// Drives this near to a limit are at it.
constexpr double kAtLimit = 1e-6;

double limitOf(const DriveLimits& limits, Eigen::Index emitter) {
  return limits.upper.size() == 0 ? kInfinite : limits.upper[emitter];
}

}  // namespace

double levelWithin(const Eigen::VectorXd& drives, const DriveLimits& limits) {
  if (limits.upper.size() != 0) {
    spectral::requireAsMany("limits", limits.upper.size(), "the drives", drives.size());
  }
  double level = kInfinite;
  for (Eigen::Index k = 0; k < drives.size(); ++k) {
    const double upper = limits.upper.size() == 0 ? 1 : limits.upper[k];
    if (drives[k] > 0) {
      level = std::min(level, upper / drives[k]);
    }
  }
  if (limits.power.size() != 0) {
    spectral::requireAsMany("powers", limits.power.size(), "the drives", drives.size());
    const double power = limits.power.dot(drives);
    level = power > 0 ? std::min(level, limits.powerBudget / power) : level;
  }
  return level;
}

LevelMatch matchAtFreeLevel(const MatchWithin& match, const DriveLimits& limits) {
  LevelMatch result{match({}), 1};
  result.level = levelWithin(result.outcome.match.drives, limits);
  if (!std::isfinite(result.level)) {
    throw InputError("--level", "level", "free", "has no end: no emitter that is used has a limit; give --limits");
  }
  result.outcome.match.drives *= result.level;
  return result;
}

std::optional<LimitCost> costOfLimits(const MatchOutcome& within, const MatchWithin& match, const DriveLimits& limits) {
  if (limits.empty()) {
    return std::nullopt;
  }
  const MatchOutcome without = match({});
  LimitCost cost;
  cost.asked = without.match.drives;
  for (Eigen::Index k = 0; k < cost.asked.size(); ++k) {
    const double upper = limitOf(limits, k);
    if (within.match.drives[k] > (1 - kAtLimit) * upper && cost.asked[k] > (1 + kAtLimit) * upper) {
      cost.held.push_back(static_cast<int>(k));
    }
  }
  cost.budgetIsSpent = limits.power.size() != 0 &&
                       limits.power.dot(within.match.drives) > (1 - kAtLimit) * limits.powerBudget &&
                       limits.power.dot(cost.asked) > (1 + kAtLimit) * limits.powerBudget;
  if (cost.held.empty() && !cost.budgetIsSpent) {
    return std::nullopt;
  }
  cost.meanWithin = summaryOf(differencesOf(within)).mean;
  cost.meanWithout = summaryOf(differencesOf(without)).mean;
  DriveLimits stated = limits;
  if (stated.upper.size() == 0) {
    stated.upper = Eigen::VectorXd::Constant(cost.asked.size(), kInfinite);
  }
  cost.level = levelWithin(cost.asked, stated);
  return cost;
}

DriveSteps stepsOf(const MatchOutcome& outcome, const std::string& unit, const Eigen::VectorXd& full, double level,
                   const std::vector<PanelEotf>& eotfs) {
  const double steps = unit == "percent" ? 10000 : unit == "dmx8" ? 255 : unit == "dmx16" ? 65535 : 0;
  if (steps == 0) {
    throw InputError("", "unit", unit, "must be percent, dmx8 or dmx16");
  }
  spectral::requireAsMany("full drives", full.size(), "the drives", outcome.match.drives.size());
  spectral::requireAbove("level", level, 0);
  if (!eotfs.empty()) {
    spectral::requireAsMany("ramps", static_cast<std::int64_t>(eotfs.size()), "the drives", full.size());
  }
  DriveSteps result;
  result.unit = unit;
  result.values.resize(full.size());
  Eigen::Matrix3Xd made = Eigen::Matrix3Xd::Zero(3, outcome.wanted.cols());
  for (Eigen::Index k = 0; k < full.size(); ++k) {
    const double whole = std::isfinite(full[k]) ? full[k] : 1;
    spectral::requireAbove("full drive", whole, 0);
    const double share = outcome.match.drives[k] / whole;
    const auto emitter = static_cast<std::size_t>(k);
    if (share > 1 + kAtLimit) {
      throw InputError(
          "", "drive", outcome.emitters[emitter],
          spectral::formatted("is %.4g %% of full: --limits keep it to full at the cost of colour, --level "
                              "free at the cost of light",
                              100 * share));
    }
    const double light = std::min(share, 1.0);
    const double rounded = std::round(steps * (eotfs.empty() ? light : eotfs[emitter].driveFor(light)));
    result.values[k] = unit == "percent" ? rounded / 100 : rounded;
    const double given = eotfs.empty() ? rounded / steps : eotfs[emitter].lightOf(rounded / steps);
    made += given * whole / level * outcome.emitterCharts[emitter];
  }
  const auto summary = summaryOf(chartDifferences(made, outcome.wanted, outcome.xyzFromResponse, outcome.white));
  result.meanDifference = summary.mean;
  result.maxDifference = summary.max;
  return result;
}

}  // namespace metamer::stage
