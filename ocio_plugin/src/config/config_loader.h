// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "config/config_document.h"
#include "config/config_items.h"

namespace metamer::ocio {

/// Loads a config with the OCIO at hand, validates it, and builds the look and the named transform of every item.
/// Where its profile is later than that OCIO knows, the items are put into a new config of profile 2.1 instead.
/// @param folder  the config's
/// @return whether the config itself was loaded
/// @throws spectral::InputError with OCIO's reason
bool checkLoads(const std::string& text, const ConfigFacts& facts, const std::filesystem::path& folder,
                const std::vector<ConfigItem>& items, const std::string& where);

}  // namespace metamer::ocio
