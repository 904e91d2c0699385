// SPDX-License-Identifier: Apache-2.0
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "commands.h"
#include "library.h"
#include "light_figures.h"
#include "metamer/ocio/lut_writer.h"
#include "metamer/ocio/shader_bake.h"
#include "metamer/spectral/data_library.h"
#include "metamer/spectral/input_error.h"

namespace metamer::lutgen {
namespace {

struct ListOptions {
  std::string kind;
  std::vector<std::string> words;
  bool json = false;
};

std::vector<std::string> namesOf(const std::string& kind, const spectral::DataLibrary& library) {
  if (kind == "illuminants") {
    return library.illuminantNames();
  }
  if (kind == "observers") {
    return library.observerNames();
  }
  if (kind == "filters") {
    return library.filterNames();
  }
  return library.reflectanceSetNames();
}

bool isDescribed(const std::string& kind) {
  return kind == "illuminants" || kind == "observers" || kind == "filters";
}

/// One object a name: first its name, then what else is known of it.
nlohmann::ordered_json entriesOf(const std::string& kind, const std::string& words) {
  auto entries = nlohmann::ordered_json::array();
  if (kind == "formats") {
    for (const ocio::LutFormat& format : ocio::lutFormats()) {
      entries.push_back({{"name", format.name},
                         {"extension", format.extension},
                         {"holds", format.use},
                         {"shaper", format.holdsShaperCurve},
                         {"shader", false}});
    }
    for (const ocio::ShaderFormat& format : ocio::shaderFormats()) {
      entries.push_back({{"name", format.name},
                         {"extension", format.extension},
                         {"holds", format.use},
                         {"shaper", false},
                         {"shader", true}});
    }
    return entries;
  }
  const auto library = openLibrary();
  if (kind == "spaces") {
    for (const spectral::ColourSpace& space : library.colourSpaces()) {
      entries.push_back(
          {{"name", space.name}, {"pixels", space.encoding ? "log" : "linear"}, {"linear", space.linear.name}});
    }
    return entries;
  }
  for (const std::string& name : words.empty() ? namesOf(kind, library) : library.namesFound(kind, words)) {
    const spectral::Provenance origin = library.provenance(kind, name);
    nlohmann::ordered_json entry = {{"name", name}};
    if (isDescribed(kind)) {
      addDescription(entry, kind, name, library);
    }
    entry.update({{"file", origin.file}, {"source", origin.source}, {"licence", origin.licence}});
    entries.push_back(entry);
  }
  return entries;
}

void list(const ListOptions& options) {
  std::string words;
  for (const std::string& word : options.words) {
    words += (words.empty() ? "" : " ") + word;
  }
  if (!words.empty() && !isDescribed(options.kind)) {
    throw CLI::ValidationError("WORDS", "search illuminants, observers and filters alone");
  }
  const nlohmann::ordered_json entries = entriesOf(options.kind, words);
  if (!words.empty() && entries.empty()) {
    throw spectral::InputError("", options.kind, words, "finds none; all names: lutgen list " + options.kind);
  }
  if (options.json) {
    std::cout << entries.dump(2) << '\n';
    return;
  }
  for (const auto& entry : entries) {
    std::cout << entry["name"].get<std::string>();
    if (options.kind == "formats") {
      std::cout << '\t' << entry["extension"].get<std::string>() << '\t' << entry["holds"].get<std::string>();
    } else if (isDescribed(options.kind)) {
      std::cout << '\t' << figuresOf(entry) << '\t' << entry["description"].get<std::string>();
    }
    std::cout << '\n';
  }
}

}  // namespace

void addList(CLI::App& application) {
  CLI::App* command = application.add_subcommand("list", "Print what can be named");
  const auto options = std::make_shared<ListOptions>();
  command->add_option("KIND", options->kind, "illuminants, observers, filters, reflectances, spaces or formats")
      ->required()
      ->check(CLI::IsMember({"illuminants", "observers", "filters", "reflectances", "spaces", "formats"}));
  command->add_option("WORDS", options->words, "Only what these words find: sodium, tungsten, fluorescent, CTO");
  command->add_flag("--json", options->json, "For programs: with figures, words, files, sources and licences");
  command->callback([options] { list(*options); });
}

}  // namespace metamer::lutgen
