// SPDX-License-Identifier: Apache-2.0
#include "recipe_with_spectra.h"

#include <string>
#include <vector>

#include "metamer/spectral/path_text.h"
#include "spectrum_like.h"

namespace metamer::python {
namespace {

/// Stand in for what is given, while the names are looked up.
constexpr const char* kAnyLight = "E";
constexpr const char* kAnyObserver = "CIE 1931 2";

sip::RecipePipeline namesOnly(const sip::RecipePipeline& named, const RecipeWithSpectra::Side& side) {
  sip::RecipePipeline result = named;
  if (side.illuminant) {
    result.illuminant = kAnyLight;
  }
  if (side.observer) {
    result.observer = kAnyObserver;
  }
  result.filters.clear();
  for (std::size_t i = 0; i < named.filters.size(); ++i) {
    if (!side.filters.contains(i)) {
      result.filters.push_back(named.filters[i]);
    }
  }
  return result;
}

void putSpectra(sip::Pipeline& pipeline, const sip::RecipePipeline& named, const RecipeWithSpectra::Side& side) {
  if (side.illuminant) {
    pipeline.illuminant = *side.illuminant;
  }
  if (side.observer) {
    pipeline.observer = *side.observer;
  }
  for (const auto& [place, spectrum] : side.filters) {
    pipeline.filters.insert(pipeline.filters.begin() + static_cast<std::ptrdiff_t>(place),
                            {spectrum, named.filters[place].density});
  }
}

bool hasSpectra(const RecipeWithSpectra::Side& side) {
  return side.illuminant || side.observer || !side.filters.empty();
}

}  // namespace

bool RecipeWithSpectra::isNamed() const {
  return !hasSpectra(input) && !hasSpectra(output);
}

sip::TransformSpec resolve(const RecipeWithSpectra& recipe, const spectral::DataLibrary& library) {
  sip::Recipe names = recipe.named;
  names.input = namesOnly(recipe.named.input, recipe.input);
  names.output = namesOnly(recipe.named.output, recipe.output);
  sip::TransformSpec spec = sip::resolve(names, library);
  putSpectra(spec.input, recipe.named.input, recipe.input);
  putSpectra(spec.output, recipe.named.output, recipe.output);
  return spec;
}

RecipeWithSpectra recipeFrom(nb::handle object) {
  if (nb::isinstance<RecipeWithSpectra>(object)) {
    return nb::cast<RecipeWithSpectra>(object);
  }
  if (const auto file = nameOrFile(object)) {
    return {sip::readRecipe(spectral::pathOf(*file)), {}, {}};
  }
  throw nb::type_error("recipe: must be a metamer.Recipe or a recipe's file");
}

}  // namespace metamer::python
