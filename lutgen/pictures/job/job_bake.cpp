// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <set>

#include "job/job.h"
#include "library.h"
#include "metamer/ocio/lut_writer.h"
#include "metamer/ocio/working_space.h"
#include "metamer/sip/recipe.h"
#include "metamer/spectral/formatted.h"
#include "metamer/spectral/input_error.h"
#include "metamer/spectral/path_text.h"

namespace metamer::lutgen {
namespace {

using farm::Piece;

struct Arguments {
  std::vector<std::string> recipes;
  std::string folder;
  std::string format = ".ctf";
  std::vector<std::string> bakeWords;
  farm::TargetOptions target;
};

/// Recipes' files and the looks' names. @throws spectral::InputError: what a recipe lacks, two looks of one name
std::vector<farm::TaskValue> looksOf(const std::vector<std::string>& recipes) {
  const auto library = openLibrary();
  const auto config = ocio::ConfigSource::environment();
  std::vector<farm::TaskValue> values = {{"Recipe", {}, true}, {"Look", {}, false}};
  std::set<std::string> names;
  for (const std::string& text : recipes) {
    const std::filesystem::path file = spectral::pathOf(text);
    const sip::Recipe recipe = sip::readRecipe(file);
    sip::resolve(recipe, library, ocio::workingSpaceOf(recipe, library, config).engine);
    if (!names.insert(recipe.name).second) {
      throw spectral::InputError(text, "name", recipe.name,
                                 "is another recipe's too; give each look a name of its own");
    }
    values[0].values.push_back(spectral::utf8(std::filesystem::absolute(file).lexically_normal()));
    values[1].values.push_back(recipe.name);
  }
  return values;
}

void write(const Arguments& arguments) {
  const farm::JobTarget target = arguments.target.target();
  const std::string extension = (arguments.format.rfind('.', 0) == 0 ? "" : ".") + arguments.format;
  ocio::lutFormat(spectral::pathOf("look" + extension), "");  // refuses what is none
  const std::filesystem::path folder = spectral::pathOf(arguments.folder);
  const std::vector<farm::TaskValue> values = looksOf(arguments.recipes);
  std::vector<std::string> words = {"bake", arguments.recipes.front(), "-o", "look" + extension};
  words.insert(words.end(), arguments.bakeWords.begin(), arguments.bakeWords.end());
  requireUnderstood(addBake, words);

  farm::JobStep step{"Bake", values, {}, ""};
  step.words = {plain("bake"),
                {{Piece::Kind::Value, "Recipe"}},
                plain("-o"),
                {{Piece::Kind::File, "Looks"},
                 {Piece::Kind::Text, "/"},
                 {Piece::Kind::Value, "Look"},
                 {Piece::Kind::Text, extension}}};
  for (const std::string& word : arguments.bakeWords) {
    step.words.push_back(plain(word));
  }
  const std::size_t count = arguments.recipes.size();
  const farm::FarmJob job{"bake looks",
                          spectral::formatted("%zu looks as %s", count, extension.c_str()),
                          lutgenProgram(),
                          {{"Looks", folder, farm::JobFile::Flow::Out, true}},
                          {step}};
  const std::string next = farm::writeJob(job, target);
  summarise(spectral::formatted("%s: %zu looks, a task each; next: %s", spectral::utf8(target.folder).c_str(), count,
                                next.c_str()));
}

}  // namespace

void addJobBake(CLI::App& job, const std::vector<std::string>& words) {
  CLI::App* command = job.add_subcommand("bake", "The looks of a show, one a task");
  const auto arguments = std::make_shared<Arguments>();
  arguments->bakeWords = words;
  command->add_option("RECIPES", arguments->recipes, "Recipe files")->required()->expected(-1);
  command->add_option("-o,--output", arguments->folder, "Folder for the looks")->required();
  command->add_option("--format", arguments->format, "Their extension: ctf (the default), clf, cube ...");
  arguments->target.addTo(*command);
  command->footer("After --: options of bake for every task: lutgen job bake ... -- --size 33");
  command->callback([arguments] { write(*arguments); });
}

}  // namespace metamer::lutgen
