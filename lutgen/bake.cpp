// SPDX-License-Identifier: Apache-2.0
#include "metamer/ocio/bake.h"

#include <memory>
#include <optional>

#include "commands.h"
#include "metamer/ocio/shaper.h"
#include "metamer/ocio/working_space.h"
#include "overrides.h"

namespace metamer::lutgen {
namespace {

/// A CLF stands for linear pixels of any exposure that its curve holds: finer than the cube of a grading program.
constexpr int kClfSize = 65;

struct BakeArguments {
  std::string recipe;
  std::string output;
  std::string format;
  std::string shaper;
  int size = 0;
  bool sampled = false;
  Overrides overrides;
};

void bake(const BakeArguments& arguments) {
  const ocio::LutFormat& format = ocio::lutFormat(arguments.output, arguments.format);
  ocio::BakeOptions options;
  options.size = arguments.size != 0 || format.extension != ".clf" ? arguments.size : kClfSize;
  if (!arguments.shaper.empty()) {
    options.shaper = ocio::shaperFromName(arguments.shaper);
  }
  options.fitted = !arguments.sampled;
  options.config = ocio::configFromEnvironment();
  const auto library = spectral::DataLibrary::openDefault();
  const sip::Recipe recipe = recipeWith(arguments.recipe, arguments.overrides, library);
  ocio::bakeFile(recipe, library, arguments.output, format.name, options);
}

}  // namespace

void addBake(CLI::App& application) {
  CLI::App* command =
      application.add_subcommand("bake", "Write a transform as a LUT file, with its certificate beside it");
  const auto arguments = std::make_shared<BakeArguments>();
  command->add_option("RECIPE", arguments->recipe, "Recipe file; without one, the options below say it all");
  command->add_option("-o,--output", arguments->output, "File to write; FILE.json beside it is the certificate")
      ->required();
  std::vector<std::string> formats;
  for (const ocio::LutFormat& format : ocio::lutFormats()) {
    formats.push_back(format.name);
  }
  command->add_option("--format", arguments->format, "Format (lutgen list formats); by the extension by default")
      ->check(CLI::IsMember(formats, CLI::ignore_case));
  command->add_option("--size", arguments->size, "Nodes along a side; 33 for .cube, 65 for others by default")
      ->check(CLI::Range(ocio::kSmallestTable, ocio::kLargestTable));
  command->add_flag("--sampled", arguments->sampled, "Nodes are the transform's values, not solved for least error");
  command->add_option("--shaper", arguments->shaper, "Log curve of .cube and .clf; ACEScct by default");
  addOverrides(*command, arguments->overrides);
  command->callback([arguments] { bake(*arguments); });
}

}  // namespace metamer::lutgen
