// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "stage/stage_result.h"

namespace metamer::lutgen {

/// The report of a solved wall for people, as Markdown.
/// @param figure  picture to show, relative to the report; empty: none
std::string reportOf(const StageResult& result, const std::string& figure);

}  // namespace metamer::lutgen
