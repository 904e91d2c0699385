// SPDX-License-Identifier: Apache-2.0
#include "metamer/ocio/bake.h"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "commands.h"
#include "library.h"
#include "metamer/ocio/log_cube.h"
#include "metamer/ocio/shader_bake.h"
#include "metamer/ocio/shaper.h"
#include "metamer/ocio/working_space.h"
#include "metamer/spectral/formatted.h"
#include "metamer/spectral/input_error.h"
#include "metamer/spectral/path_text.h"
#include "metamer/spectral/pending_file.h"
#include "metamer/spectral/text.h"
#include "overrides.h"
#include "positive_number.h"
#include "progress.h"
#include "run.h"
#include "words.h"

namespace metamer::lutgen {
namespace {

struct BakeArguments {
  std::string recipe;
  std::string output;
  std::string format;
  std::string shaper;
  int size = 0;
  bool sampled = false;
  std::string certify = "quick";
  bool inverse = false;
  std::optional<double> tolerance;
  std::vector<int> stops;
  int shaperSize = 0;
  std::optional<std::string> inputSpace;
  std::optional<std::string> outputSpace;
  std::string config;
  std::vector<std::string> luts;
  bool toStdout = false;
  Overrides overrides;
};

/// ociobakelut has a space in and a space out; here they are one, which it calls the working space of a look.
sip::Recipe recipeOf(const BakeArguments& arguments, const spectral::DataLibrary& library) {
  Overrides overrides = arguments.overrides;
  if (arguments.inputSpace) {
    if (overrides.space && *overrides.space != *arguments.inputSpace) {
      throw CLI::ValidationError("--inputspace", "is the same as --space; give one of them");
    }
    overrides.space = arguments.inputSpace;
  }
  sip::Recipe recipe = recipeWith(arguments.recipe, overrides, library);
  if (arguments.outputSpace && *arguments.outputSpace != recipe.space) {
    throw spectral::InputError(
        "--outputspace", "space", *arguments.outputSpace,
        "a transform stays in its space, " + recipe.space + "; name the same, and convert in a step of its own");
  }
  return recipe;
}

ocio::BakeOptions optionsOf(const BakeArguments& arguments) {
  ocio::BakeOptions options;
  options.size = arguments.size;
  if (!arguments.shaper.empty()) {
    options.shaper = ocio::shaperFromName(arguments.shaper);
  }
  options.fitted = !arguments.sampled;
  options.fullCertificate = arguments.certify == "full";
  options.tolerance = arguments.tolerance;
  if (!arguments.stops.empty()) {
    options.lowestStop = arguments.stops[0];
    options.highestStop = arguments.stops[1];
  }
  options.shaperSize = arguments.shaperSize;
  options.config = arguments.config.empty() ? ocio::ConfigSource::environment() : ocio::configNamed(arguments.config);
  return options;
}

/// What was tried on the way to a tolerance, one line each.
void report(const ocio::Certificate& certificate) {
  if (!certificate.choice) {
    return;
  }
  for (const auto& tried : certificate.choice->tried) {
    const bool isChosen = &tried == &certificate.choice->tried.back();
    words() << representationText(tried.representation, tried.size) << ": p99 " << tried.p99 << ", max " << tried.max
            << (isChosen ? ", chosen" : "") << '\n';
  }
}

/// Every extension, with its formats' names where it has several: ".ctf, .cube (iridas_cube, resolve_cube)".
std::string allExtensions() {
  std::vector<std::pair<std::string, std::vector<std::string>>> extensions;
  const auto add = [&](const std::string& extension, const std::string& name) {
    const auto known =
        std::find_if(extensions.begin(), extensions.end(), [&](const auto& entry) { return entry.first == extension; });
    (known == extensions.end() ? extensions.emplace_back(extension, std::vector<std::string>{}) : *known)
        .second.push_back(name);
  };
  for (const ocio::LutFormat& format : ocio::lutFormats()) {
    add(format.extension, format.name);
  }
  for (const ocio::ShaderFormat& format : ocio::shaderFormats()) {
    add(format.extension, format.name);
  }
  std::string text;
  for (const auto& [extension, names] : extensions) {
    text += (text.empty() ? "" : ", ") + extension;
    for (std::size_t k = 0; names.size() > 1 && k < names.size(); ++k) {
      text += (k == 0 ? " (" : ", ") + names[k] + (k + 1 == names.size() ? ")" : "");
    }
  }
  return text;
}

/// @throws spectral::InputError where the extension is no format's, shaders' neither
const ocio::LutFormat& lutFormatOf(const BakeArguments& arguments) {
  if (arguments.toStdout) {
    return ocio::lutFormatNamed(arguments.format);
  }
  const auto& formats = ocio::lutFormats();
  const std::string extension = spectral::lowerCase(spectral::utf8(spectral::pathOf(arguments.output).extension()));
  if (arguments.format.empty() && std::none_of(formats.begin(), formats.end(), [&](const ocio::LutFormat& format) {
        return format.extension == extension;
      })) {
    throw spectral::InputError(arguments.output, "extension", extension, "unknown; the formats are " + allExtensions());
  }
  return ocio::lutFormat(spectral::pathOf(arguments.output), arguments.format);
}

void convert(const BakeArguments& arguments, const ocio::LutFormat& format) {
  if (!arguments.toStdout && spectral::isStream(spectral::pathOf(arguments.output))) {
    standardOutput();
  }
  std::vector<std::filesystem::path> luts;
  std::transform(arguments.luts.begin(), arguments.luts.end(), std::back_inserter(luts), spectral::pathOf);
  const std::string text = ocio::convertedLuts(luts, format, arguments.size, arguments.shaperSize);
  if (arguments.toStdout) {
    standardOutput() << text;
  } else {
    spectral::writeWholeFile(spectral::pathOf(arguments.output), text);
  }
  summarise((arguments.toStdout ? format.name : arguments.output) + ": " + std::to_string(luts.size()) +
            (luts.size() == 1 ? " LUT file" : " LUT files") + " written anew");
}

void bake(const BakeArguments& arguments) {
  if (arguments.inverse) {
    throw spectral::InputError("", "inverse", "",
                               "is not made: colours that the input light hid are one colour in the result, and "
                               "nothing tells them apart again; "
                               "exchange input and output in the recipe, which relights the result back");
  }
  if (arguments.toStdout != arguments.output.empty()) {
    throw CLI::ValidationError("bake", "needs either -o FILE or --stdout");
  }
  if (arguments.toStdout && arguments.format.empty()) {
    throw CLI::ValidationError("--stdout", "needs --format");
  }
  if (!arguments.toStdout) {
    spectral::requireWritable(spectral::pathOf(arguments.output));
  }
  const ocio::ShaderFormat* const shader = ocio::findShaderFormat(spectral::pathOf(arguments.output), arguments.format);
  const ocio::LutFormat* const format = shader != nullptr ? nullptr : &lutFormatOf(arguments);
  const std::string& formatName = shader != nullptr ? shader->name : format->name;
  if (!arguments.luts.empty()) {
    if (shader != nullptr) {
      throw CLI::ValidationError("--lut", "is nothing for " + shader->extension + ", which holds a recipe's own map");
    }
    convert(arguments, *format);
    return;
  }
  const auto library = openLibrary();
  const sip::Recipe recipe = recipeOf(arguments, library);
  ocio::BakeOptions options = optionsOf(arguments);
  if (arguments.toStdout || spectral::isStream(spectral::pathOf(arguments.output))) {
    standardOutput();  // no word may come between
  }
  const std::string what = arguments.toStdout ? formatName : arguments.output;
  const ocio::Certificate certificate = [&] {
    Progress progress(what);
    options.progress = [&progress](double share) { progress.show(share); };
    if (!arguments.toStdout) {
      const std::filesystem::path output = spectral::pathOf(arguments.output);
      return shader != nullptr ? ocio::bakeShaderFile(recipe, library, output, *shader, options)
                               : ocio::bakeFile(recipe, library, output, formatName, options);
    }
    ocio::BakedText baked = shader != nullptr ? ocio::bakeShaderText(recipe, library, *shader, options)
                                              : ocio::bakeText(recipe, library, formatName, options);
    standardOutput() << baked.text;
    return std::move(baked.certificate);
  }();
  note(certificate.notes);
  note(certificate.warnings());
  report(certificate);
  summarise(what + ": " + representationText(certificate.representation, certificate.size) +
            spectral::formatted(", p99 %.3g", certificate.error.p99));
}

}  // namespace

void addBake(CLI::App& application) {
  CLI::App* command =
      application.add_subcommand("bake", "Write a transform as a LUT or shader file, with its certificate beside it");
  const auto arguments = std::make_shared<BakeArguments>();
  CLI::Option* recipe =
      command->add_option("RECIPE", arguments->recipe, "Recipe file; without one, the options below say it all");
  command->add_option("-o,--output", arguments->output, "File to write; FILE.json beside it is the certificate");
  command->add_flag("--stdout", arguments->toStdout, "Write to standard output, without a certificate file");
  std::vector<std::string> formats;
  for (const ocio::LutFormat& format : ocio::lutFormats()) {
    formats.push_back(format.name);
    formats.push_back(format.extension.substr(1));
  }
  for (const ocio::ShaderFormat& format : ocio::shaderFormats()) {
    formats.push_back(format.name);
    formats.push_back(format.extension.substr(1));
  }
  command->add_option("--format", arguments->format, "Format (lutgen list formats); by the extension by default")
      ->check(CLI::IsMember(formats, CLI::ignore_case));
  command
      ->add_option("--size,--cubesize", arguments->size,
                   "Nodes along a side; 33 for .cube, 65 for others by default; the most where there is a tolerance")
      ->check(CLI::Range(ocio::kSmallestTable, ocio::kLargestTable));
  command->add_flag("--inverse", arguments->inverse, "Refused: says why, and what does it in its place");
  command
      ->add_option(
          "--certify", arguments->certify,
          "quick, or full: four times the probes, and the error on measured surfaces left out of the scene, beside "
          "plain adaptation and a root polynomial")
      ->check(CLI::IsMember({"quick", "full"}));
  command->add_flag("--sampled", arguments->sampled, "Nodes are the transform's values, not solved for least error");
  command
      ->add_option("--tolerance", arguments->tolerance,
                   "99th percentile of CIEDE2000 to hold, with the cheapest that does: nothing, a matrix, a table")
      ->check(positiveNumber());
  command->add_option("--stops", arguments->stops, "Exposures to judge by, round 18 % grey: LOWEST HIGHEST")
      ->expected(2)
      ->check(CLI::Range(-24, 24));
  command
      ->add_option("--shapersize", arguments->shaperSize,
                   "Entries of the curve before a table, where the format has one")
      ->check(CLI::Range(ocio::kFewestCurveEntries, ocio::kMostCurveEntries));
  command->add_option("--inputspace", arguments->inputSpace, "The same as --space");
  command->add_option("--outputspace", arguments->outputSpace, "The same space again: a transform stays in it");
  CLI::Option* luts = command->add_option("--lut", arguments->luts,
                                          "LUT file to write in another format, in place of a recipe; may be repeated");
  luts->expected(1)->take_all()->excludes(recipe);
  command->add_option("--iconfig", arguments->config, "Config in place of the one in $OCIO")->excludes(luts);
  command->add_option(
      "--shaper,--shaperspace", arguments->shaper,
      "Curve of .cube and its like: a camera's log, ACEScct by default, or a display's: sRGB, Rec.1886, \"Gamma 2.4\"");
  addOverrides(*command, arguments->overrides);
  command->callback([arguments] { bake(*arguments); });
}

}  // namespace metamer::lutgen
