// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "metamer/stage/match_outcome.h"
#include "metamer/stage/panel_eotf.h"
#include "metamer/stage/wall_intervals.h"

namespace metamer::stage {

/// A match solved once more within other limits.
using MatchWithin = std::function<MatchOutcome(const DriveLimits& limits)>;

/// The factor by which drives may grow (or must shrink) until the first limit holds them; limits without an upper drive
/// take 1. Infinite where all drives are 0.
/// @throws spectral::InputError where limits are not as many as the drives
double levelWithin(const Eigen::VectorXd& drives, const DriveLimits& limits);

/// A light whose colour is matched, not its level.
struct LevelMatch {
  MatchOutcome outcome;  ///< drives as sent; the chart and the differences are at the target's level
  double level = 1;      ///< the light over the target
};

/// As bright as the limits allow: the best drives without limits, all by one factor.
/// @throws spectral::InputError as levelWithin, and what `match` throws
LevelMatch matchAtFreeLevel(const MatchWithin& match, const DriveLimits& limits);

/// What limits cost a match of a light at its level.
struct LimitCost {
  std::vector<int> held;       ///< emitters at their largest drive that ask for more without it
  bool budgetIsSpent = false;  ///< the sum of powers is at its largest
  Eigen::VectorXd asked;       ///< drives without limits
  double meanWithout = 0;      ///< mean CIEDE2000 without limits
  double meanWithin = 0;       ///< within them
  double level = 1;            ///< at which the limits would cost no colour at all
};

/// @return nothing where the limits hold nothing back
std::optional<LimitCost> costOfLimits(const MatchOutcome& within, const MatchWithin& match, const DriveLimits& limits);

/// Drives as a desk takes them.
struct DriveSteps {
  std::string unit;           ///< "percent", "dmx8" or "dmx16"
  Eigen::VectorXd values;     ///< whole steps for DMX; percent to two decimals
  double meanDifference = 0;  ///< mean CIEDE2000 of the rounded drives
  double maxDifference = 0;
};

/// @param unit    "percent", "dmx8" (0 ... 255) or "dmx16" (0 ... 65535)
/// @param full    the drive of 100 % of each emitter, above 0; infinite ones count as 1
/// @param level   of a LevelMatch; 1 otherwise
/// @param eotfs   of each emitter, whose light is not proportional to what is sent; empty: it is
/// @throws spectral::InputError: an unknown unit, a drive above full, eotfs that are not as many as the drives
DriveSteps stepsOf(const MatchOutcome& outcome, const std::string& unit, const Eigen::VectorXd& full, double level = 1,
                   const std::vector<PanelEotf>& eotfs = {});

/// 95 % intervals of drives that were matched from captured charts.
struct MatchIntervals {
  int samples = 0;
  CaptureNoise noise;
  std::string noiseIs;  ///< "stated", "estimated from the charts", "assumed"
  Interval<Eigen::VectorXd> drives;
  Interval<double> mean;  ///< CIEDE2000; as loweredEnds()
};

/// The match of charts once more.
using MatchOfCharts = std::function<MatchOutcome(std::vector<ChartTable> emitterCharts, const ChartTable& target)>;

/// @param options  noise, samples, seed and runAll are used
/// @throws spectral::InputError for options out of their range, and what `match` throws
MatchIntervals matchIntervals(const std::vector<ChartTable>& emitterCharts, const ChartTable& target,
                              const MatchOfCharts& match, const IntervalOptions& options);

}  // namespace metamer::stage
