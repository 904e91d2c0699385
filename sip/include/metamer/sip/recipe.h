// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "metamer/sip/spectral_transform.h"
#include "metamer/spectral/data_library.h"

namespace metamer::sip {

/// A filter as a recipe names it: a NAME of data/ or a FILE, with a density.
struct RecipeFilter {
  std::string name;
  double density = 1.0;
};

struct RecipePipeline {
  std::string illuminant;
  std::vector<RecipeFilter> filters;
  std::string observer = "CIE 1931 2";
};

struct RecipeScene {
  ReferenceScene::Kind kind = ReferenceScene::Kind::Natural;
  std::string set;                 ///< Dataset: its reflectance set; Pairs: theirs, or a file of colours (readPairs)
  double strength = 1.0;           ///< Skin: 0 = as Natural ... 1
  double fade = kDefaultSkinFade;  ///< Skin: ReferenceScene::fade
  ReferenceScene::Kind over = ReferenceScene::Kind::Natural;  ///< Pairs: ReferenceScene::over
  double radius = kDefaultPairRadius;                         ///< Pairs: ReferenceScene::radius
};

/// The one description that lutgen, configs, the plugin and the validator share (docs/recipe.md). YAML:
///
///     metamer: 1
///     name: day_to_sodium
///     space: ACEScg
///     input:  {illuminant: D65, filters: [], observer: CIE 1931 2}
///     output: {illuminant: HP1, filters: [{file: gel.csv, density: 0.5}], observer: CIE 1931 2, adaptation: 0.0}
///     scene:  {kind: natural}  # or smooth, skin, dataset, pairs, smits, mallett, jakob, meng
///     cat: vonkries
///     balanced: vonkries
///
/// A filter is a NAME, or a map with `name` or `file`, and `density`. `keep_exposure: true` keeps the light that
/// filters cost. Only `metamer`, and the two illuminants, must be there.
struct Recipe {
  std::string name = "transform";
  std::string space = "ACEScg";
  RecipePipeline input;
  RecipePipeline output;
  double adaptation = 0.0;
  RecipeScene scene;
  spectral::ChromaticAdaptation cat = spectral::ChromaticAdaptation::VonKries;
  std::optional<Balance> balanced;  ///< none given: by `cat`
  bool keepExposure = false;
  std::string where;             ///< the recipe's file, for messages; empty where it has none
  std::filesystem::path folder;  ///< where relative files are looked for: the recipe file's own folder
};

/// Recipes may not be larger than this.
inline constexpr std::uintmax_t kLargestRecipeBytes = 1u << 20;

/// @throws spectral::InputError with file, line, field, value and remedy: not YAML, another version, an unknown or
///         repeated key (near names listed), a value of the wrong kind or out of range
Recipe readRecipe(const std::filesystem::path& file);
Recipe parseRecipe(const std::string& text, const std::string& where);

/// The recipe as YAML in a fixed order with every field: what certificates embed. Parsing it gives the recipe back.
std::string toYaml(const Recipe& recipe);

/// Looks every name up. The working space is the recipe's own (its linear part), or `space` where the caller has
/// resolved it elsewhere.
/// @throws spectral::InputError for a name or file that is not there (near names listed)
TransformSpec resolve(const Recipe& recipe, const spectral::DataLibrary& library);
TransformSpec resolve(const Recipe& recipe, const spectral::DataLibrary& library, const spectral::RgbSpace& space);

/// What reading its files changed, and what they lack, a line each: "input.illuminant lamp.csv: 3 values below zero
/// ...".
/// @param spec  of the recipe, resolved
std::vector<std::string> notesOf(const Recipe& recipe, const TransformSpec& spec);

}  // namespace metamer::sip
