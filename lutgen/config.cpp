// SPDX-License-Identifier: Apache-2.0
#include <OpenColorIO/OpenColorIO.h>

#include <algorithm>
#include <iostream>
#include <memory>
#include <set>

#include "commands.h"
#include "library.h"
#include "metamer/ocio/config_writer.h"
#include "metamer/ocio/log_cube.h"
#include "metamer/spectral/formatted.h"
#include "metamer/spectral/path_text.h"
#include "progress.h"
#include "run.h"

namespace metamer::lutgen {
namespace {

struct ConfigArguments {
  std::vector<std::string> recipes;
  std::string output;
  std::string base;
  ocio::ConfigOptions options;
};

void writeConfig(const ConfigArguments& arguments) {
  const auto library = openLibrary();
  std::vector<sip::Recipe> recipes;
  for (const std::string& file : arguments.recipes) {
    recipes.push_back(sip::readRecipe(spectral::pathOf(file)));
  }
  ocio::ConfigOptions options = arguments.options;
  options.base = spectral::pathOf(arguments.base);
  const ocio::ConfigReport report = [&] {
    Progress progress(arguments.output);
    options.progress = [&progress](double share) { progress.show(share); };
    return ocio::writeConfig(recipes, library, spectral::pathOf(arguments.output), options);
  }();
  for (const ocio::ConfigEntry& entry : report.entries) {
    note(entry.certificate.notes);
    if (options.tolerance && entry.certificate.error.p99 > *options.tolerance) {
      std::cout << entry.name << ": p99 " << entry.certificate.error.p99
                << " is beyond the tolerance; a larger --size is needed\n";
    }
  }
  for (const std::string& unused : report.unused) {
    note({unused + " is read by no look of " + arguments.output + " any more"});
  }
  if (!report.isLoaded) {
    std::cout << arguments.output << ": profile " << report.majorVersion << '.' << report.minorVersion
              << " is later than OpenColorIO " << OCIO_NAMESPACE::GetVersion()
              << " knows; what is added was checked in a config of profile 2.1\n";
  }
  double worst = 0;
  std::set<std::string> kinds;
  for (const ocio::ConfigEntry& entry : report.entries) {
    worst = std::max(worst, entry.certificate.error.p99);
    kinds.insert(ocio::nameOf(entry.certificate.representation));
  }
  std::string representations;
  for (const std::string& kind : kinds) {
    representations += (representations.empty() ? "" : ", ") + kind;
  }
  const std::size_t count = report.entries.size();
  summarise(arguments.output + ": " + std::to_string(count) + (count == 1 ? " look, " : " looks, ") + representations +
            spectral::formatted(", p99 %.3g%s", worst, count == 1 ? "" : " at most"));
}

}  // namespace

void addConfig(CLI::App& application) {
  CLI::App* command =
      application.add_subcommand("config", "Write an OCIO config with a look and a named transform a recipe");
  const auto arguments = std::make_shared<ConfigArguments>();
  command->add_option("RECIPE", arguments->recipes, "Recipe files")->required();
  command
      ->add_option("-o,--output", arguments->output,
                   "Config to write; its LUT files, and a certificate a recipe, go into a folder beside it")
      ->required();
  command->add_option("--base", arguments->base, "Config to add to; every byte of it is kept. A new config without");
  command->add_flag("--replace", arguments->options.replaces,
                    "Renew looks that are there already, each in its place; without --base, of the config to write");
  command->add_option("--lut-folder", arguments->options.lutFolder, "Name of the folder; luts by default");
  command->add_option("--name", arguments->options.name, "Name of a new config; the file's by default");
  command->add_option("--description", arguments->options.description, "Description of a new config");
  command->add_option("--family", arguments->options.family, "Family of the named transforms; metamer by default");
  command->add_option("--size", arguments->options.size, "Nodes along a side of the tables; 65 by default")
      ->check(CLI::Range(ocio::kSmallestTable, ocio::kLargestTable));
  command
      ->add_option("--tolerance", arguments->options.tolerance,
                   "99th percentile of CIEDE2000 to hold with the least: nothing, a matrix, tables up to --size")
      ->check(CLI::Range(0.0, 100.0));
  command->callback([arguments] { writeConfig(*arguments); });
}

}  // namespace metamer::lutgen
