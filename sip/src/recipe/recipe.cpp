// SPDX-License-Identifier: Apache-2.0
#include "metamer/sip/recipe.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <system_error>

#include "metamer/sip/band_weights.h"
#include "metamer/sip/pairs.h"
#include "metamer/spectral/input_error.h"
#include "metamer/spectral/naming_file.h"
#include "metamer/spectral/near_names.h"
#include "metamer/spectral/path_text.h"
#include "metamer/spectral/spectral_files.h"
#include "metamer/spectral/text.h"
#include "metamer/spectral/yaml_value.h"
#include "scenes/measured_surfaces.h"
#include "transform/sides.h"

namespace metamer::sip {
namespace {

using spectral::InputError;
using spectral::YamlMap;
using spectral::YamlValue;

constexpr double kLargestDensity = 100.0;
constexpr const char* kStandardObserver = "CIE 1931 2";
constexpr const char* kDaylight = "D65";  // what cameras' matrices are made for

RecipeFilter readFilter(const YamlValue& value) {
  if (value.isScalar()) {
    return {value.text(), 1.0};
  }
  const YamlMap section(value, {"name", "file", "density"});
  RecipeFilter filter;
  const auto name = section.find("name");
  const auto file = section.find("file");
  if (name.has_value() == file.has_value()) {
    throw section.error("must have either a name or a file");
  }
  filter.name = name ? name->text() : file->text();
  // A file without folder or extension would be taken for a name.
  if (file && filter.name.find('/') == std::string::npos && filter.name.find('\\') == std::string::npos) {
    filter.name = "./" + filter.name;
  }
  section.read("density", filter.density, 0.0, kLargestDensity);
  return filter;
}

RecipePipeline readPipeline(const YamlMap& section) {
  RecipePipeline pipeline;
  pipeline.illuminant = section.require("illuminant", "is missing; name the light, such as 'illuminant: D65'").text();
  section.read("observer", pipeline.observer);
  if (const auto filters = section.find("filters")) {
    if (!filters->isSequence()) {
      throw filters->error("must be a list, such as [gel.csv]");
    }
    for (const YamlValue& filter : filters->items()) {
      pipeline.filters.push_back(readFilter(filter));
    }
  }
  return pipeline;
}

void readOver(const YamlMap& section, RecipeScene& scene) {
  if (const auto over = section.find("over")) {
    const std::string name = over->text();
    for (const auto kind : {ReferenceScene::Kind::Natural, ReferenceScene::Kind::Skin, ReferenceScene::Kind::Smooth}) {
      if (name == nameOf(kind)) {
        scene.over = kind;
        return;
      }
    }
    throw over->error("must be natural, skin or smooth");
  }
}

RecipeScene readScene(const YamlMap& section) {
  RecipeScene scene;
  std::string kind = nameOf(scene.kind);
  section.read("kind", kind);
  try {
    scene.kind = sceneKindFromName(kind);
  } catch (const InputError&) {
    throw section.find("kind")->error(sceneKindRemedy(kind));
  }
  section.read("set", scene.set);
  section.read("strength", scene.strength, 0.0, 1.0);
  section.read("fade", scene.fade, kLeastSkinFade, kLargestSkinFade);
  const bool hasPairs = scene.kind == ReferenceScene::Kind::Pairs;
  readOver(section, scene);
  scene.radius = scene.over == ReferenceScene::Kind::Smooth ? kSmoothPairRadius : kDefaultPairRadius;
  section.read("radius", scene.radius, kLeastPairRadius, kLargestPairRadius);
  if (scene.kind == ReferenceScene::Kind::Dataset) {
    section.require("set", "is missing; name a reflectance set (see: lutgen list reflectances)");
  } else if (hasPairs) {
    section.require("set", "is missing; name the file of the colours and their spectra (see: lutgen pairs add)");
  }
  const bool hasSkin =
      scene.kind == ReferenceScene::Kind::Skin || (hasPairs && scene.over == ReferenceScene::Kind::Skin);
  const auto refuseUnless = [&](bool isMeant, const char* name, const char* kinds) {
    if (const auto field = section.find(name); field && !isMeant) {
      throw field->error(std::string("has a meaning with kind ") + kinds + " alone; leave it out");
    }
  };
  refuseUnless(hasPairs || scene.kind == ReferenceScene::Kind::Dataset, "set", "dataset or pairs");
  refuseUnless(hasPairs, "radius", "pairs");
  refuseUnless(hasPairs, "over", "pairs");
  refuseUnless(hasSkin, "strength", "skin");
  refuseUnless(hasSkin, "fade", "skin");
  return scene;
}

/// Text as a YAML scalar that reads back as the same text.
std::string quoted(const std::string& text) {
  const auto isPlain = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; };
  if (!text.empty() && std::all_of(text.begin(), text.end(), isPlain) && text != "null" && text != "Null" &&
      text != "NULL") {
    return text;
  }
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      result += '\\';
    }
    result += c;
  }
  return result + '"';
}

std::string toYaml(const RecipePipeline& pipeline) {
  std::string text = "{illuminant: " + quoted(pipeline.illuminant) + ", filters: [";
  for (std::size_t i = 0; i < pipeline.filters.size(); ++i) {
    const RecipeFilter& filter = pipeline.filters[i];
    text += std::string(i == 0 ? "" : ", ") + "{name: " + quoted(filter.name) +
            ", density: " + spectral::shortestNumber(filter.density) + "}";
  }
  return text + "], observer: " + quoted(pipeline.observer);
}

/// Runs a look-up and says in its error where in the recipe the name stands.
template <typename Look>
auto lookUp(const Recipe& recipe, const char* field, Look look) {
  try {
    return look();
  } catch (const InputError& error) {
    throw InputError(recipe.where, field + std::string(": ") + error.what(), "", "");
  }
}

Pipeline resolvePipeline(const Recipe& recipe, const char* side, const RecipePipeline& named,
                         const spectral::DataLibrary& library) {
  return lookUp(recipe, side, [&] {
    Pipeline pipeline{
        library.illuminant(named.illuminant, recipe.folder), {}, library.observer(named.observer, recipe.folder)};
    for (const auto& filter : named.filters) {
      pipeline.filters.push_back({library.filter(filter.name, recipe.folder), filter.density});
    }
    return pipeline;
  });
}

}  // namespace

Recipe readRecipe(const std::filesystem::path& file) {
  std::error_code none;
  const auto size = std::filesystem::file_size(file, none);
  if (!none && std::filesystem::is_regular_file(file, none) && size > kLargestRecipeBytes) {
    throw InputError(spectral::utf8(file), "size", std::to_string(size),
                     "is more than a recipe may have (" + std::to_string(kLargestRecipeBytes) + " bytes)");
  }
  Recipe recipe = parseRecipe(spectral::readTextFile(file), spectral::utf8(file));
  recipe.folder = file.parent_path();
  return recipe;
}

Recipe parseRecipe(const std::string& text, const std::string& where) {
  if (text.size() > kLargestRecipeBytes) {
    throw InputError(where, "size", std::to_string(text.size()),
                     "is more than a recipe may have (" + std::to_string(kLargestRecipeBytes) + " bytes)");
  }
  const YamlMap top(YamlValue::parse(text, where),
                    {"metamer", "name", "space", "input", "output", "scene", "cat", "balanced", "keep_exposure"});
  top.requireVersion();
  Recipe recipe;
  recipe.where = where;
  top.read("name", recipe.name);
  top.read("space", recipe.space);
  top.read("keep_exposure", recipe.keepExposure);

  recipe.input = readPipeline({top.require("input", "is missing; give the light, such as 'input: {illuminant: D65}'"),
                               {"illuminant", "filters", "observer"}});
  const YamlMap output(top.require("output", "is missing; give the light, such as 'output: {illuminant: A}'"),
                       {"illuminant", "filters", "observer", "adaptation"});
  recipe.output = readPipeline(output);
  output.read("adaptation", recipe.adaptation, 0.0, 1.0);

  if (const auto scene = top.find("scene")) {
    recipe.scene = readScene({*scene, {"kind", "set", "strength", "fade", "over", "radius"}});
  }
  if (const auto cat = top.find("cat")) {
    const std::string name = cat->text();
    try {
      recipe.cat = spectral::chromaticAdaptationFromName(name);
    } catch (const InputError&) {
      throw cat->error("must be vonkries, bradford, cat02 or cat16");
    }
  }
  if (const auto balanced = top.find("balanced")) {
    const std::string name = balanced->text();
    try {
      recipe.balanced = balanceFromName(name);
    } catch (const InputError&) {
      throw balanced->error(kBalanceRemedy);
    }
  }
  return recipe;
}

std::string toYaml(const Recipe& recipe) {
  std::string text = "metamer: 1\nname: " + quoted(recipe.name) + "\nspace: " + quoted(recipe.space) +
                     "\ninput: " + toYaml(recipe.input) + "}\noutput: " + toYaml(recipe.output) +
                     ", adaptation: " + spectral::shortestNumber(recipe.adaptation) + "}\n";
  text += "scene: {kind: " + nameOf(recipe.scene.kind);
  const bool hasPairs = recipe.scene.kind == ReferenceScene::Kind::Pairs;
  if (hasPairs || recipe.scene.kind == ReferenceScene::Kind::Dataset) {
    text += ", set: " + quoted(recipe.scene.set);
  }
  if (hasPairs) {
    text += ", over: " + nameOf(recipe.scene.over) + ", radius: " + spectral::shortestNumber(recipe.scene.radius);
  }
  if (recipe.scene.kind == ReferenceScene::Kind::Skin ||
      (hasPairs && recipe.scene.over == ReferenceScene::Kind::Skin)) {
    text += ", strength: " + spectral::shortestNumber(recipe.scene.strength) +
            ", fade: " + spectral::shortestNumber(recipe.scene.fade);
  }
  text += "}\n";
  text += "cat: " + spectral::nameOf(recipe.cat) + "\n";
  text += "balanced: " + nameOf(recipe.balanced.value_or(Balance{.cat = recipe.cat})) + "\n";
  return text + "keep_exposure: " + (recipe.keepExposure ? "true" : "false") + "\n";
}

namespace {

/// The training surfaces under daylight, as an uplift takes colours.
std::vector<Eigen::Vector3d> daylightColours(const TransformSpec& spec, const spectral::Uplift& uplift) {
  const Eigen::Matrix3Xd weights =
      bandWeights(spec.daylight->onDomain(), spec.standardObserver.onDomain(), kConvergedBandCount);
  const double white = weights.row(1).sum();
  const Eigen::Matrix3d rgbFromXyz = uplift.xyzFromRgb().inverse() / white;
  std::vector<Eigen::Vector3d> colours;
  colours.reserve(spec.training.size());
  for (const spectral::DomainSamples& surface : spec.training) {
    colours.emplace_back(rgbFromXyz * (weights * surface));
  }
  return colours;
}

}  // namespace

TransformSpec resolve(const Recipe& recipe, const spectral::DataLibrary& library) {
  return resolve(recipe, library, lookUp(recipe, "space", [&] { return library.colourSpace(recipe.space).linear; }));
}

TransformSpec resolve(const Recipe& recipe, const spectral::DataLibrary& library, const spectral::RgbSpace& space) {
  TransformSpec spec{.space = space,
                     .input = resolvePipeline(recipe, "input", recipe.input, library),
                     .output = resolvePipeline(recipe, "output", recipe.output, library),
                     .adaptation = recipe.adaptation,
                     .cat = recipe.cat,
                     .keepExposure = recipe.keepExposure,
                     .scene = {.kind = recipe.scene.kind,
                               .samples = {},
                               .skins = {},
                               .strength = recipe.scene.strength,
                               .virtualSkins = {},
                               .fade = recipe.scene.fade,
                               .pairs = {},
                               .pairNames = {},
                               .over = recipe.scene.over,
                               .radius = recipe.scene.radius,
                               .uplift = nullptr,
                               .sampleColours = {}},
                     .training = measuredSurfaces(library),
                     .standardObserver = library.observer(kStandardObserver),
                     .balanced = recipe.balanced,
                     .daylight = library.illuminant(kDaylight)};
  switch (recipe.scene.kind) {
    case ReferenceScene::Kind::Smooth:
      break;
    case ReferenceScene::Kind::Pairs:
      lookUp(recipe, "scene", [&] {
        for (const Pair& pair : readPairs(recipe.scene.set, library, recipe.folder)) {
          spec.scene.pairs.push_back(pair.reflectance);
          spec.scene.pairNames.push_back(pair.name);
        }
        return 0;
      });
      spec.scene.samples = spec.training;
      spec.scene.skins = modelSkins(library);
      if (recipe.scene.over == ReferenceScene::Kind::Skin) {
        spec.scene.virtualSkins = virtualSkins(library);
      }
      break;
    case ReferenceScene::Kind::Dataset:
      spec.scene.samples =
          lookUp(recipe, "scene", [&] { return onDomain(library.reflectances(recipe.scene.set, recipe.folder)); });
      break;
    case ReferenceScene::Kind::Skin:
      spec.scene.virtualSkins = virtualSkins(library);
      [[fallthrough]];
    case ReferenceScene::Kind::Natural:
      spec.scene.samples = spec.training;
      spec.scene.skins = modelSkins(library);
      break;
    case ReferenceScene::Kind::Smits:
    case ReferenceScene::Kind::Mallett:
    case ReferenceScene::Kind::Jakob:
    case ReferenceScene::Kind::Meng:
      spec.scene.uplift = spectral::makeUplift(*upliftOf(recipe.scene.kind), library);
      spec.scene.samples = spec.training;
      spec.scene.sampleColours = daylightColours(spec, *spec.scene.uplift);
      break;
  }
  // What is wrong with the two sides is known where the recipe's file is known.
  for (const auto& [side, pipeline] : {std::pair("input", &spec.input), std::pair("output", &spec.output)}) {
    lookUp(recipe, side, [&, given = pipeline] { return prepare(*given, spec.training, spec.standardObserver); });
  }
  spectral::namingFile(recipe.where, [&] { return prepareSides(spec); });
  return spec;
}

namespace {

/// Of a user's own set of reflectances: what is brighter than white is named once, with the brightest place.
std::vector<std::string> notesOfDataset(const Recipe& recipe, const TransformSpec& spec) {
  constexpr double kBrightest = 1.02;  // what measurement makes of white
  double most = kBrightest;
  Eigen::Index place = 0;
  std::size_t count = 0;
  const bool isFile =
      recipe.scene.kind == ReferenceScene::Kind::Dataset && spectral::looksLikeSpectralFile(recipe.scene.set);
  for (const spectral::DomainSamples& sample : isFile ? spec.scene.samples : std::vector<spectral::DomainSamples>()) {
    Eigen::Index at = 0;
    const double brightest = sample.maxCoeff(&at);
    count += brightest > kBrightest ? 1 : 0;
    place = brightest > most ? at : place;
    most = std::max(most, brightest);
  }
  if (count == 0) {
    return {};
  }
  return {std::to_string(count) + " of " + std::to_string(spec.scene.samples.size()) +
          " reflect more than arrives, up to " + spectral::threeDigits(most) + " at " +
          std::to_string(spectral::kDomainStartNm + place) +
          " nm: a reflectance cannot hold this; fluorescence, or a white that was set too low"};
}

}  // namespace

std::vector<std::string> notesOf(const Recipe& recipe, const TransformSpec& spec) {
  std::vector<std::string> notes;
  const auto add = [&](const std::string& role, const std::string& name, const spectral::Spectrum& spectrum) {
    const std::filesystem::path path = spectral::pathOf(name);
    const std::string shown = path.is_absolute() ? spectral::utf8(path.filename()) : name;
    for (const std::string& note : spectrum.notes()) {
      notes.push_back(role + " " + shown + ": " + note);
    }
  };
  const auto addSide = [&](const std::string& side, const RecipePipeline& named, const Pipeline& pipeline) {
    add(side + ".illuminant", named.illuminant, pipeline.illuminant);
    for (std::size_t k = 0; k < named.filters.size(); ++k) {
      add(side + ".filters[" + std::to_string(k) + "]", named.filters[k].name, pipeline.filters[k].transmittance);
    }
  };
  addSide("input", recipe.input, spec.input);
  addSide("output", recipe.output, spec.output);
  for (const auto& found : {notesOfPairs(spec), notesOfDataset(recipe, spec)}) {
    for (const std::string& note : found) {
      notes.push_back("scene.set " + recipe.scene.set + ": " + note);
    }
  }
  // Who says that the light's colour was taken out may not expect to see the next one's.
  if (recipe.balanced && recipe.balanced->kind != Balance::Kind::None && recipe.adaptation == 0.0 &&
      spectral::lowerCase(recipe.input.illuminant) != spectral::lowerCase(recipe.output.illuminant)) {
    notes.push_back("balanced " + nameOf(*recipe.balanced) +
                    " with adaptation 0: greys take on the colour that the output light has beside the input light, as "
                    "where a locked camera meets another lamp; adaptation 1 keeps them grey");
  }
  return notes;
}

}  // namespace metamer::sip
