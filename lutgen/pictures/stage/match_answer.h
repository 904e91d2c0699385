// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "metamer/stage/match_limits.h"
#include "metamer/stage/panel_eotf.h"
#include "stage/stage_json.h"

namespace metamer::lutgen {

/// A match with what was asked of it beside its drives.
struct MatchAnswer {
  stage::MatchOutcome outcome;
  std::string filter;                              ///< before the target's lamp; empty: none
  std::optional<double> level;                     ///< where it is free
  std::optional<stage::LimitCost> limitCost;       ///< where limits hold something back
  std::optional<stage::DriveSteps> steps;          ///< where a unit is asked for
  std::vector<stage::PanelEotf> eotfs;             ///< that the steps went through; empty: light is proportional
  std::optional<stage::MatchIntervals> intervals;  ///< where charts were captured
};

/// One match, as MatchOutcome's JSON and more.
Json toJson(const MatchAnswer& answer);
std::string summaryOf(const MatchAnswer& answer);
/// @param figure  picture to show, relative to the report; empty: none
std::string reportOf(const MatchAnswer& answer, const std::string& figure);

/// Several targets: a line each.
Json toJson(const std::vector<MatchAnswer>& answers);
std::string summaryOf(const std::vector<MatchAnswer>& answers);
std::string reportOf(const std::vector<MatchAnswer>& answers);

}  // namespace metamer::lutgen
