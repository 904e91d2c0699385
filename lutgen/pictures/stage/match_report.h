// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "metamer/spectral/data_library.h"
#include "metamer/stage/match_outcome.h"
#include "stage/stage_json.h"

namespace metamer::lutgen {

Json toJson(const stage::MatchOutcome& outcome);
std::string reportOf(const stage::MatchOutcome& outcome, const std::string& figure);
std::string summaryOf(const stage::MatchOutcome& outcome);
/// The chart as squares in squares. @throws spectral::InputError
void writeFigure(const stage::MatchOutcome& outcome, const spectral::DataLibrary& library,
                 const std::filesystem::path& file);

}  // namespace metamer::lutgen
