// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <memory>

#include "metamer/ocio/pixel_processor.h"
#include "metamer/ocio/working_space.h"
#include "metamer/sip/homogeneous_map.h"
#include "metamer/sip/recipe.h"
#include "metamer/spectral/input_error.h"
#include "metamer/spectral/text.h"
#include "overrides.h"
#include "picture.h"
#include "picture_commands.h"
#include "run.h"

namespace metamer::lutgen {
namespace {

using PixelFunction = std::function<void(std::span<float> rgba)>;

struct ApplyOptions {
  std::string transform;
  std::string input;
  std::string output;
  std::string engine = "exact";
  int threads = 0;
  Overrides overrides;
};

bool isRecipe(const std::filesystem::path& file) {
  const std::string extension = spectral::lowerCase(file.extension().string());
  return extension == ".yaml" || extension == ".yml";
}

/// Built-in log curves in double precision; spaces of a config through OCIO.
PixelFunction conversion(const ocio::WorkingSpace& space, bool toEngine) {
  if (space.encoding) {
    const spectral::LogEncoding encoding = *space.encoding;
    return [encoding, toEngine](std::span<float> rgba) {
      for (std::size_t i = 0; i < rgba.size(); ++i) {
        if (i % 4 != 3) {
          rgba[i] = static_cast<float>(toEngine ? decode(encoding, rgba[i]) : encode(encoding, rgba[i]));
        }
      }
    };
  }
  const ocio::PixelProcessor processor(toEngine ? space.toEngine : space.fromEngine);
  return [processor](std::span<float> rgba) { processor.apply(rgba); };
}

PixelFunction fromRecipe(const ApplyOptions& options) {
  const auto library = spectral::DataLibrary::openDefault();
  const sip::Recipe recipe = recipeWith(options.transform, options.overrides, library);
  const ocio::WorkingSpace space = ocio::findWorkingSpace(recipe.space, library, ocio::ConfigSource::environment());
  const sip::TransformSpec spec = sip::resolve(recipe, library, space.engine);
  note(sip::notesOf(recipe, spec));
  const auto transform = std::make_shared<const sip::SpectralTransform>(spec);
  if (transform->isIdentity()) {
    return [](std::span<float>) {};
  }
  PixelFunction engine = [transform](std::span<float> rgba) { transform->apply(rgba); };
  if (options.engine == "map") {
    const auto map = std::make_shared<const sip::HomogeneousMap>(sip::buildHomogeneousMap(*transform));
    engine = [map](std::span<float> rgba) { map->apply(rgba); };
  }
  if (!space.toEngine) {
    return engine;
  }
  const PixelFunction before = conversion(space, true);
  const PixelFunction after = conversion(space, false);
  return [=](std::span<float> rgba) {
    before(rgba);
    engine(rgba);
    after(rgba);
  };
}

PixelFunction fromLut(const std::string& file) {
  const ocio::PixelProcessor processor = ocio::PixelProcessor::fromFile(file);
  return [processor](std::span<float> rgba) { processor.apply(rgba); };
}

void apply(const ApplyOptions& options, bool hasOverrides) {
  const bool recipe = isRecipe(options.transform);
  if (!recipe && hasOverrides) {
    throw CLI::ValidationError("apply", "a LUT file is applied as it is; options of recipes need a recipe");
  }
  Picture picture(options.input);
  picture.forEachRow(recipe ? fromRecipe(options) : fromLut(options.transform), options.threads);
  picture.write(options.output);
}

}  // namespace

void addApply(CLI::App& application) {
  CLI::App* command = kApply.addTo(application);
  const auto options = std::make_shared<ApplyOptions>();
  command->add_option("TRANSFORM", options->transform, "Recipe (.yaml), or a LUT file that OpenColorIO reads")
      ->required();
  command->add_option("IN", options->input, "Picture to read; its pixels are in the recipe's space")->required();
  command->add_option("OUT", options->output, "Picture to write")->required();
  command->add_option("--threads", options->threads, "Threads; 0: as many as the machine has")
      ->check(CLI::Range(0, 1024));
  CLI::Option* engine =
      command
          ->add_option("--engine", options->engine,
                       "exact: every pixel solved; map: a table within a tenth of a CIEDE2000, faster")
          ->check(CLI::IsMember({"exact", "map"}));
  addOverrides(*command, options->overrides);
  command->callback([options, command, engine] {
    const auto given = command->get_options([engine](const CLI::Option* option) {
      return option->count() > 0 && (option == engine || option->get_group().rfind("Recipe", 0) == 0);
    });
    apply(*options, !given.empty());
  });
}

}  // namespace metamer::lutgen
