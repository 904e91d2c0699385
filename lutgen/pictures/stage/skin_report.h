// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "metamer/stage/skin_priority.h"
#include "stage/stage_json.h"

namespace metamer::lutgen {

Json toJson(const stage::SkinDifferences& differences);
Json toJson(const std::vector<stage::SkinTradeOff>& tradeOffs);

/// "0.46 +- 0.21, at most 1.20"
std::string textOf(const stage::SkinDifferences& differences);

/// The curve to choose a weight on: lines for a terminal, and a table in Markdown. The weight in use is marked.
std::string curveOf(const std::vector<stage::SkinTradeOff>& tradeOffs, double weight);
std::string tableOf(const std::vector<stage::SkinTradeOff>& tradeOffs, double weight);

}  // namespace metamer::lutgen
