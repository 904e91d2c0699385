// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace metamer::stage {

/// The patches whose names hold a word, or begin with it, without regard to case.
std::vector<int> patchesWith(const std::vector<std::string>& names, const std::string& word, bool atStart);

/// The patch of a name, without regard to case; else the only one that begins with it; else -1.
int patchNamed(const std::vector<std::string>& names, const std::string& name);

}  // namespace metamer::stage
