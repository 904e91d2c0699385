// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "metamer/stage/panel_eotf.h"
#include "stage/stage_json.h"

namespace metamer::lutgen {

/// A fitted EOTF for programs, and in words.
Json toJson(const stage::PanelEotf& eotf);
std::string textOf(const stage::PanelEotf& eotf);

}  // namespace metamer::lutgen
