// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "metamer/sip/recipe.h"

namespace metamer::lutgen {

/// What the command line says about a recipe, in place of what the recipe says.
struct Overrides {
  std::optional<std::string> name;
  std::optional<std::string> space;
  std::optional<std::string> illuminantIn;
  std::optional<std::string> illuminantOut;
  std::vector<std::string> filtersIn;
  std::vector<std::string> filtersOut;
  std::optional<std::string> observerIn;
  std::optional<std::string> observerOut;
  std::optional<std::string> scene;
  std::optional<std::string> cat;
  std::optional<std::string> balanced;
  std::optional<double> adaptation;
  bool keepExposure = false;
};

/// Adds the flags. `overrides` must outlive the parsing.
void addOverrides(CLI::App& command, Overrides& overrides);

/// The recipe of a file (none: the defaults) with the overrides. Files named on the command line are looked for in the
/// working folder, those of the recipe beside it.
/// @throws spectral::InputError; CLI::ValidationError where an illuminant is missing
sip::Recipe recipeWith(const std::string& recipeFile, const Overrides& overrides, const spectral::DataLibrary& library);

}  // namespace metamer::lutgen
