// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <yaml-cpp/yaml.h>

#include <string>

#include "config/config_document.h"

namespace metamer::ocio {

/// Parses a config's text.
/// @throws spectral::InputError: no YAML (with the line), not a map, too deep or too large
YAML::Node parseConfigYaml(const std::string& text, const std::string& where);

/// @throws spectral::InputError: not a config
ConfigFacts readConfigFacts(const YAML::Node& root, const std::string& where);

/// Entries of a search path: a list, or text with colons between.
std::vector<std::string> searchPathOf(const YAML::Node& node);

/// Whether two nodes have the same tags, values and order.
bool isSameYaml(const YAML::Node& a, const YAML::Node& b);

}  // namespace metamer::ocio
