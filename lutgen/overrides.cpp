// SPDX-License-Identifier: Apache-2.0
#include "overrides.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <filesystem>

#include "metamer/spectral/input_error.h"
#include "metamer/spectral/path_text.h"
#include "metamer/spectral/spectral_files.h"
#include "metamer/spectral/text.h"

namespace metamer::lutgen {
namespace {

using spectral::InputError;

constexpr const char* kSceneForms =
    "natural, smooth, skin[:strength[:fade]], dataset:SET, pairs:FILE[:radius], or as an uplift has it: smits, "
    "mallett, jakob or meng";

/// A name as it is; a file by its whole path, so that it is not looked for beside the recipe.
std::string fromWorkingFolder(const std::string& nameOrFile, const std::vector<std::string>& names) {
  const auto isName = [&](const std::string& name) {
    return spectral::lowerCase(name) == spectral::lowerCase(nameOrFile);
  };
  if (!spectral::looksLikeSpectralFile(nameOrFile) || std::any_of(names.begin(), names.end(), isName)) {
    return nameOrFile;
  }
  const auto [file, column] = spectral::spectralFileName(nameOrFile);
  return spectral::utf8(std::filesystem::absolute(spectral::pathOf(file)).lexically_normal()) +
         (column.empty() ? "" : ":" + column);
}

/// The whole text as a number.
std::optional<double> number(const std::string& text) {
  double value = 0;
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (failure != std::errc{} || end != text.data() + text.size()) {
    return std::nullopt;
  }
  return value;
}

/// NAME[:density]; "none" for no filter.
std::vector<sip::RecipeFilter> filtersFrom(const std::vector<std::string>& texts, const std::string& flag,
                                           const std::vector<std::string>& names) {
  std::vector<sip::RecipeFilter> filters;
  for (const std::string& text : texts) {
    if (text == "none") {
      continue;
    }
    sip::RecipeFilter filter{text, 1.0};
    const std::size_t colon = text.rfind(':');
    if (colon != std::string::npos && colon > 0) {
      if (const std::optional<double> density = number(text.substr(colon + 1))) {
        if (!std::isfinite(*density) || *density < 0) {
          throw InputError(flag, "density", text, "must be 0 or more, and finite; 1 is the filter as it is");
        }
        filter = {text.substr(0, colon), *density};
      }
    }
    filter.name = fromWorkingFolder(filter.name, names);
    filters.push_back(filter);
  }
  return filters;
}

/// A number of a scene within its range.
double dial(const std::string& name, const std::string& text, double least, double most) {
  const std::optional<double> value = number(text);
  if (!value || !(*value >= least && *value <= most)) {
    throw InputError("--scene", name, text,
                     "must be a number from " + spectral::shortestNumber(least) + " to " +
                         spectral::shortestNumber(most) + "; write " + kSceneForms);
  }
  return *value;
}

/// natural | smooth | skin[:strength[:fade]] | dataset:SET | pairs:FILE[:radius] | smits | mallett | jakob | meng
sip::RecipeScene sceneFrom(const std::string& text, const std::vector<std::string>& names) {
  const std::string form = std::string("write ") + kSceneForms;
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == ':') {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  if (parts[0] == "prior") {
    throw InputError("--scene", "scene", text, "prior is gone: natural and skin took its place; " + form);
  }
  sip::RecipeScene scene;
  try {
    scene.kind = sip::sceneKindFromName(parts[0]);
  } catch (const InputError&) {
    throw InputError("--scene", "scene", text, parts[0] == "otsu" ? sip::sceneKindRemedy(parts[0]) : form);
  }
  const bool isDataset = scene.kind == sip::ReferenceScene::Kind::Dataset;
  const bool isSkin = scene.kind == sip::ReferenceScene::Kind::Skin;
  const bool hasPairs = scene.kind == sip::ReferenceScene::Kind::Pairs;
  if (parts.size() > (isSkin || hasPairs ? 3U
                      : isDataset        ? 2U
                                         : 1U) ||
      ((isDataset || hasPairs) && parts.size() < 2) || parts.back().empty()) {
    throw InputError("--scene", "scene", text, form);
  }
  if (isDataset || hasPairs) {
    scene.set = fromWorkingFolder(parts[1], names);
    if (parts.size() > 2) {
      scene.radius = dial("radius", parts[2], sip::kLeastPairRadius, sip::kLargestPairRadius);
    }
  } else if (isSkin && parts.size() > 1) {
    scene.strength = dial("strength", parts[1], 0.0, 1.0);
    if (parts.size() > 2) {
      scene.fade = dial("fade", parts[2], sip::kLeastSkinFade, sip::kLargestSkinFade);
    }
  }
  return scene;
}

}  // namespace

void addOverrides(CLI::App& command, Overrides& overrides) {
  const std::string group = "Recipe, in place of what the file says";
  command.add_option("--name", overrides.name, "Name of the transform")->group(group);
  command.add_option("--illuminant-in", overrides.illuminantIn, "Light that the picture was shot under: NAME or FILE")
      ->group(group);
  command.add_option("--illuminant-out", overrides.illuminantOut, "Light that it should appear under: NAME or FILE")
      ->group(group);
  const std::string filter = "NAME or FILE, with :density where it is not 1; may be repeated; none for no filter";
  command.add_option("--filter-in", overrides.filtersIn, filter)->group(group)->expected(1)->take_all();
  command.add_option("--filter-out", overrides.filtersOut, filter)->group(group)->expected(1)->take_all();
  command.add_option("--observer-in", overrides.observerIn, "NAME or FILE")->group(group);
  command.add_option("--observer-out", overrides.observerOut, "NAME or FILE")->group(group);
  command.add_option("--scene", overrides.scene, kSceneForms)->group(group);
  command.add_option("--space", overrides.space, "Working space, in and out: built in, or of the config in $OCIO")
      ->group(group);
  command.add_option("--cat", overrides.cat, "Chromatic adaptation")
      ->group(group)
      ->check(CLI::IsMember({"vonkries", "bradford", "cat02", "cat16"}));
  command.add_option("--balanced", overrides.balanced, "How the shot was white-balanced; left out: as --cat")
      ->group(group)
      ->check(CLI::IsMember({"camera", "rgb", "none", "vonkries", "bradford", "cat02", "cat16"}));
  command
      .add_option("--adaptation", overrides.adaptation, "0: the eye stays with the input light ... 1: neutrals stay")
      ->group(group)
      ->check(CLI::Range(0.0, 1.0));
  command.add_flag("--keep-exposure", overrides.keepExposure, "Keep the light that filters cost")->group(group);
}

sip::Recipe recipeWith(const std::string& recipeFile, const Overrides& overrides,
                       const spectral::DataLibrary& library) {
  sip::Recipe recipe;
  if (!recipeFile.empty()) {
    recipe = sip::readRecipe(spectral::pathOf(recipeFile));
  }
  const auto replace = [](std::string& value, const std::optional<std::string>& text,
                          const std::vector<std::string>& names) {
    if (text) {
      value = fromWorkingFolder(*text, names);
    }
  };
  replace(recipe.input.illuminant, overrides.illuminantIn, library.illuminantNames());
  replace(recipe.output.illuminant, overrides.illuminantOut, library.illuminantNames());
  replace(recipe.input.observer, overrides.observerIn, library.observerNames());
  replace(recipe.output.observer, overrides.observerOut, library.observerNames());
  if (!overrides.filtersIn.empty()) {
    recipe.input.filters = filtersFrom(overrides.filtersIn, "--filter-in", library.filterNames());
  }
  if (!overrides.filtersOut.empty()) {
    recipe.output.filters = filtersFrom(overrides.filtersOut, "--filter-out", library.filterNames());
  }
  if (overrides.scene) {
    recipe.scene = sceneFrom(*overrides.scene, library.reflectanceSetNames());
  }
  if (overrides.cat) {
    recipe.cat = spectral::chromaticAdaptationFromName(*overrides.cat);
  }
  if (overrides.balanced) {
    recipe.balanced = sip::balanceFromName(*overrides.balanced);
  }
  recipe.name = overrides.name.value_or(recipe.name);
  recipe.space = overrides.space.value_or(recipe.space);
  recipe.adaptation = overrides.adaptation.value_or(recipe.adaptation);
  recipe.keepExposure = recipe.keepExposure || overrides.keepExposure;
  if (recipe.input.illuminant.empty()) {
    throw CLI::ValidationError("--illuminant-in", "is needed where no recipe is given");
  }
  if (recipe.output.illuminant.empty()) {
    throw CLI::ValidationError("--illuminant-out", "is needed where no recipe is given");
  }
  return recipe;
}

}  // namespace metamer::lutgen
