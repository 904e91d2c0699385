// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <string>
#include <variant>
#include <vector>

namespace metamer::ocio {

/// One step of a look: a LUT file as the config names it, or a matrix on RGB.
using ConfigStep = std::variant<std::string, Eigen::Matrix3d>;

/// A look and a named transform that do the same, in the words of a config.
struct ConfigItem {
  std::string name;          ///< of the look
  std::string processSpace;  ///< linear: the steps work there
  std::string pixelSpace;    ///< of the named transform
  std::string family;
  std::string encoding;     ///< of pixelSpace; empty where it is not known
  std::string description;  ///< lines
  std::vector<ConfigStep> steps;
};

/// "NAME - Transform": OCIO wants names of named transforms that no look has.
std::string namedTransformName(const std::string& look);

/// Block sequences of !<Look> and !<NamedTransform>, an empty line between items.
std::string looksYaml(const std::vector<ConfigItem>& items);
std::string namedTransformsYaml(const std::vector<ConfigItem>& items);

}  // namespace metamer::ocio
