// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "metamer/stage/stage_result.h"
#include "stage/stage_json.h"

namespace metamer::lutgen {

/// The stage file for programs.
Json toJson(const stage::StageResult& result);

/// A few lines for a terminal: conditions, differences, the trade-off of N, notes.
std::string summaryOf(const stage::StageResult& result);

/// The report of a solved wall for people, as Markdown.
/// @param figure  picture to show, relative to the report; empty: none
std::string reportOf(const stage::StageResult& result, const std::string& figure);

}  // namespace metamer::lutgen
