// SPDX-License-Identifier: Apache-2.0
#include "metamer/sip/pairs.h"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "commands.h"
#include "library.h"
#include "metamer/spectral/fluorescence.h"
#include "metamer/spectral/formatted.h"
#include "metamer/spectral/input_error.h"
#include "metamer/spectral/path_text.h"
#include "metamer/spectral/pending_file.h"
#include "metamer/spectral/spectral_files.h"
#include "metamer/spectral/text.h"
#include "overrides.h"
#include "run.h"

namespace metamer::lutgen {
namespace {

using spectral::InputError;
using Json = nlohmann::ordered_json;

constexpr const char* kColourForm = "write LIGHT:X,Y,Z with Y = 1 for white, such as D65:0.21,0.13,0.02";

struct AddArguments {
  std::string file;
  std::vector<std::string> from;
  std::vector<std::string> colours;
  std::optional<std::string> fluorescent;
  std::vector<std::string> under;
  std::optional<std::string> name;
};

struct CheckArguments {
  std::string pairs;
  std::string over = "natural";
  std::optional<double> radius;
  bool isJson = false;
  bool decidesExit = false;
  Overrides overrides;
};

/// LIGHT:X,Y,Z; the light may be a file with colons.
sip::PairColour colourFrom(const std::string& text) {
  const std::size_t colon = text.rfind(':');
  if (colon == std::string::npos || colon == 0) {
    throw InputError("--colour", "colour", text, kColourForm);
  }
  sip::PairColour colour{text.substr(0, colon), Eigen::Vector3d::Zero()};
  std::string rest = text.substr(colon + 1) + ",";
  for (Eigen::Index k = 0; k < 3; ++k) {
    const std::size_t comma = rest.find(',');
    const std::optional<double> value = spectral::parseNumber(rest.substr(0, comma));
    if (!value || (k == 2) != (comma + 1 == rest.size())) {
      throw InputError("--colour", "colour", text, kColourForm);
    }
    colour.xyz[k] = *value;
    rest = rest.substr(comma + 1);
  }
  return colour;
}

/// A name that a column of a CSV can have.
std::string columnName(const std::string& name) {
  std::string plain = spectral::oneLine(name);
  std::replace_if(
      plain.begin(), plain.end(), [](char c) { return c == ',' || c == ';' || c == '"'; }, ' ');
  return std::string(spectral::trimmed(plain));
}

/// The pairs as a table that every reader of spectra takes.
std::string tableOf(const std::vector<sip::Pair>& pairs) {
  std::string text = "wavelength_nm";
  for (const sip::Pair& pair : pairs) {
    text += "," + pair.name;
  }
  for (int k = 0; k < spectral::kDomainSize; ++k) {
    text += "\n" + std::to_string(spectral::kDomainStartNm + k);
    for (const sip::Pair& pair : pairs) {
      text += "," + spectral::shortestNumber(pair.reflectance[k]);
    }
  }
  return text + "\n";
}

/// What an earlier call left; none where there is no file yet.
std::vector<sip::Pair> pairsAlready(const std::string& file, const spectral::DataLibrary& library) {
  if (!std::filesystem::exists(spectral::pathOf(file))) {
    return {};
  }
  if (sip::isTableOfColours(spectral::pathOf(file))) {
    throw InputError(file, "pairs", "", "holds colours and not spectra; add a row to it by hand, or name another file");
  }
  return sip::readPairs(spectral::utf8(std::filesystem::absolute(spectral::pathOf(file))), library);
}

/// The reflectance that looks like a fluorescent surface under each of some lights.
sip::Pair fluorescentPair(const AddArguments& arguments, const spectral::DataLibrary& library) {
  const std::filesystem::path file = spectral::pathOf(*arguments.fluorescent);
  const spectral::FluorescentSamples surface =
      spectral::samplesOf(spectral::readFluorescence(file, library.pictures()));
  const auto curves = library.observer("CIE 1931 2").onDomain();
  std::vector<sip::PairColour> colours;
  for (const std::string& light : arguments.under) {
    const spectral::ExcitationSamples arriving = spectral::onExcitation(library.illuminant(light));
    colours.push_back({light, spectral::colourOf(surface, arriving, curves)});
  }
  const std::string name = arguments.name.value_or(spectral::utf8(file.stem()));
  return sip::reflectanceOf(name, colours, library, *arguments.fluorescent, {}, sip::kFluorescentBrightest);
}

void checkUsage(const AddArguments& arguments) {
  const int sources = (arguments.from.empty() ? 0 : 1) + (arguments.colours.empty() ? 0 : 1) +
                      (arguments.fluorescent.has_value() ? 1 : 0);
  if (sources != 1) {
    throw CLI::ValidationError("pairs add",
                               "needs spectra (NAME or FILE[:COLUMN]), --colour or --fluorescent, and one");
  }
  if (!arguments.colours.empty() && !arguments.name) {
    throw CLI::ValidationError("--colour", "needs --name");
  }
  if (arguments.fluorescent.has_value() == arguments.under.empty()) {
    throw CLI::ValidationError("--fluorescent", "and --under go together: name the lights of the shot and of the look");
  }
}

void add(const AddArguments& arguments) {
  checkUsage(arguments);
  if (spectral::lowerCase(spectral::utf8(spectral::pathOf(arguments.file).extension())) != ".csv") {
    throw InputError(arguments.file, "extension", "", "must be .csv");
  }
  spectral::requireWritable(spectral::pathOf(arguments.file));
  const auto library = openLibrary();
  std::vector<sip::Pair> pairs = pairsAlready(arguments.file, library);
  std::vector<sip::Pair> added;
  for (const std::string& from : arguments.from) {
    const auto some = sip::readPairs(from, library);
    added.insert(added.end(), some.begin(), some.end());
  }
  if (!arguments.colours.empty()) {
    std::vector<sip::PairColour> colours;
    for (const std::string& colour : arguments.colours) {
      colours.push_back(colourFrom(colour));
    }
    added.push_back(sip::reflectanceOf(*arguments.name, colours, library, "--colour"));
  }
  if (arguments.fluorescent) {
    added.push_back(fluorescentPair(arguments, library));
  }
  if (arguments.name) {
    if (added.size() != 1) {
      throw InputError("--name", "name", *arguments.name,
                       "names one pair, and there are " + std::to_string(added.size()) + "; choose one by FILE:COLUMN");
    }
    added[0].name = *arguments.name;
  }
  for (sip::Pair& pair : added) {
    pair.name = columnName(pair.name);
    const auto isSame = [&](const sip::Pair& other) {
      return spectral::lowerCase(other.name) == spectral::lowerCase(pair.name);
    };
    if (std::any_of(pairs.begin(), pairs.end(), isSame)) {
      throw InputError(arguments.file, "pair", pair.name, "is there already; give another --name");
    }
    pairs.push_back(pair);
  }
  spectral::writeWholeFile(spectral::pathOf(arguments.file), tableOf(pairs));
  summarise(arguments.file + ": " + std::to_string(added.size()) + (added.size() == 1 ? " pair" : " pairs") +
            " added, " + std::to_string(pairs.size()) + " in all");
}

sip::Recipe recipeOf(const CheckArguments& arguments, const spectral::DataLibrary& library) {
  const std::string extension = spectral::lowerCase(spectral::utf8(spectral::pathOf(arguments.pairs).extension()));
  if (extension == ".yaml" || extension == ".yml") {
    return recipeWith(arguments.pairs, arguments.overrides, library);
  }
  Overrides overrides = arguments.overrides;
  overrides.illuminantIn = overrides.illuminantIn.value_or("D65");
  overrides.illuminantOut = overrides.illuminantOut.value_or("A");
  sip::Recipe recipe = recipeWith("", overrides, library);
  recipe.scene.kind = sip::ReferenceScene::Kind::Pairs;
  recipe.scene.set = arguments.pairs;
  recipe.scene.over = sip::sceneKindFromName(arguments.over);
  recipe.scene.radius = arguments.radius.value_or(
      recipe.scene.over == sip::ReferenceScene::Kind::Smooth ? sip::kSmoothPairRadius : sip::kDefaultPairRadius);
  return recipe;
}

Json jsonOf(const sip::Recipe& recipe, const std::vector<sip::CheckedPair>& checked) {
  Json list = Json::array();
  for (const sip::CheckedPair& pair : checked) {
    Json entry = {{"name", pair.name}, {"rgb", {pair.rgb[0], pair.rgb[1], pair.rgb[2]}}, {"dark", pair.isDark}};
    if (!pair.isDark) {
      entry.update({{"x", pair.chromaticity[0]},
                    {"y", pair.chromaticity[1]},
                    {"error_before", pair.errorBefore},
                    {"error", pair.error},
                    {"gain", pair.gain},
                    {"nearest", pair.nearest},
                    {"distance", pair.distance},
                    {"conflicts", pair.conflicts}});
    }
    list.push_back(entry);
  }
  return {{"metamer_pairs", 1},
          {"illuminant_in", recipe.input.illuminant},
          {"illuminant_out", recipe.output.illuminant},
          {"over", sip::nameOf(recipe.scene.over)},
          {"radius", recipe.scene.radius},
          {"pairs", list}};
}

void check(const CheckArguments& arguments) {
  const auto library = openLibrary();
  const sip::Recipe recipe = recipeOf(arguments, library);
  const sip::TransformSpec spec = sip::resolve(recipe, library);
  if (spec.scene.kind != sip::ReferenceScene::Kind::Pairs) {
    throw InputError(arguments.pairs, "scene.kind", sip::nameOf(spec.scene.kind),
                     "has no pairs to check; write scene: {kind: pairs, set: FILE}");
  }
  const std::vector<sip::CheckedPair> checked = sip::checkPairs(spec);
  std::size_t inConflict = 0;
  std::size_t dark = 0;
  std::size_t longest = 4;
  for (const sip::CheckedPair& pair : checked) {
    inConflict += pair.conflicts.empty() ? 0 : 1;
    dark += pair.isDark ? 1 : 0;
    longest = std::max(longest, std::min<std::size_t>(pair.name.size(), 32));
  }
  if (arguments.isJson) {
    standardOutput() << jsonOf(recipe, checked).dump(2, ' ', false, Json::error_handler_t::replace) << '\n';
  } else {
    const int width = static_cast<int>(longest);
    words() << spectral::formatted("%-*s  %6s %6s  %6s %6s %5s  %s", width, "pair", "x", "y", "before", "now", "gain",
                                   "nearest (CIEDE2000)")
            << '\n';
    for (const sip::CheckedPair& pair : checked) {
      const std::string name = spectral::shortened(pair.name, 32);
      if (pair.isDark) {
        words() << spectral::formatted("%-*s  black under this light: left out", width, name.c_str()) << '\n';
        continue;
      }
      words() << spectral::formatted("%-*s  %.4f %.4f  %6.2f %6.2f %5.2f  %s (%.2f)", width, name.c_str(),
                                     pair.chromaticity[0], pair.chromaticity[1], pair.errorBefore, pair.error,
                                     pair.gain, pair.nearest.c_str(), pair.distance)
              << (pair.conflicts.empty() ? "" : "  in conflict with " + spectral::joined(pair.conflicts)) << '\n';
    }
  }
  note(sip::notesOfPairs(spec));
  const std::size_t exact = checked.size() - inConflict - dark;
  summarise(arguments.pairs + ": " + std::to_string(exact) + " of " + std::to_string(checked.size()) +
            (checked.size() == 1 ? " pair" : " pairs") + " exact from " + recipe.input.illuminant + " to " +
            recipe.output.illuminant);
  if (arguments.decidesExit && inConflict > 0) {
    throw CLI::RuntimeError(kExceeded);
  }
}

}  // namespace

void addPairs(CLI::App& application) {
  CLI::App* command = application.add_subcommand("pairs", "Colours whose spectra are known: collect and check them");
  command->require_subcommand(1);

  CLI::App* adds = command->add_subcommand("add", "Add colours to a file of pairs, which is made where there is none");
  const auto added = std::make_shared<AddArguments>();
  adds->add_option("PAIRS", added->file, "File of pairs (.csv)")->required();
  adds->add_option("SPECTRA", added->from, "Measured reflectances: FILE, FILE:COLUMN, or a NAME of lutgen list");
  adds->add_option("--colour", added->colours,
                   "Instead: what the colour is under a light, LIGHT:X,Y,Z; repeat it for every light")
      ->expected(1)
      ->take_all();
  adds->add_option("--fluorescent", added->fluorescent,
                   "Instead: a fluorescent surface's file, a re-radiation matrix or the compact form");
  adds->add_option("--under", added->under, "A light that it is seen under; repeat it for every light")
      ->expected(1)
      ->take_all();
  adds->add_option("--name", added->name, "Name of the pair, where it is one");
  adds->callback([added] { add(*added); });

  CLI::App* checks = command->add_subcommand("check", "Tell how pairs come out, how near they lie and which conflict");
  const auto checked = std::make_shared<CheckArguments>();
  checks->add_option("PAIRS", checked->pairs, "File of pairs, a NAME of lutgen list, or a recipe with pairs")
      ->required();
  checks->add_option("--over", checked->over, "Scene below the pairs")
      ->check(CLI::IsMember({"natural", "skin", "smooth"}));
  checks->add_option("--radius", checked->radius, "How far a pair is felt")
      ->check(CLI::Range(sip::kLeastPairRadius, sip::kLargestPairRadius));
  checks->add_flag("--json", checked->isJson, "JSON on stdout");
  checks->add_flag("--exit-code", checked->decidesExit, "Exit 3 where pairs are in conflict");
  addOverrides(*checks, checked->overrides);
  checks->callback([checked] { check(*checked); });
}

}  // namespace metamer::lutgen
