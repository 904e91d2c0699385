// SPDX-License-Identifier: Apache-2.0
#include "metamer/sip/recipe.h"

#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <filesystem>
#include <optional>
#include <string>
#include <utility>

#include "bindings.h"
#include "metamer/spectral/path_text.h"
#include "metamer/spectral/spectral_files.h"
#include "recipe_with_spectra.h"
#include "spectrum_like.h"

using namespace nanobind::literals;

namespace metamer::python {
namespace {

/// What the constructor takes for one side.
struct SideArguments {
  nb::object illuminant;
  nb::object filters;
  nb::object observer;
};

/// A filter's entry in a recipe; a given spectrum goes to `side` and leaves its name.
nb::dict filterEntry(nb::handle item, RecipeWithSpectra::Side& side, std::size_t place) {
  nb::dict entry;
  nb::handle filter = item;
  if (nb::isinstance<nb::tuple>(item)) {
    if (nb::len(item) != 2) {
      throw nb::value_error("filter: must be a filter, or a pair of a filter and its density");
    }
    filter = nb::cast<nb::tuple>(item)[0];
    entry["density"] = nb::float_(nb::cast<nb::tuple>(item)[1]);
  }
  if (const auto name = nameOrFile(filter)) {
    entry[spectral::looksLikeSpectralFile(*name) ? "file" : "name"] = *name;
    return entry;
  }
  const auto spectrum = spectrumFrom(filter, spectral::SpectralQuantity::Transmittance);
  entry["name"] = spectrum.name();
  side.filters.emplace(place, spectrum);
  return entry;
}

/// One side's entry in a recipe, as docs/recipe.md has it.
nb::dict sideEntry(const SideArguments& arguments, RecipeWithSpectra::Side& side) {
  nb::dict entry;
  if (const auto name = nameOrFile(arguments.illuminant)) {
    entry["illuminant"] = *name;
  } else {
    side.illuminant = spectrumFrom(arguments.illuminant, spectral::SpectralQuantity::SpectralPowerDistribution);
    entry["illuminant"] = side.illuminant->name();
  }
  if (!arguments.observer.is_none()) {
    if (const auto name = nameOrFile(arguments.observer)) {
      entry["observer"] = *name;
    } else {
      side.observer = observerFrom(arguments.observer);
      entry["observer"] = side.observer->name;
    }
  }
  nb::list filters;
  std::size_t place = 0;
  for (const nb::handle item : arguments.filters) {
    filters.append(filterEntry(item, side, place++));
  }
  entry["filters"] = filters;
  return entry;
}

/// The fields as a recipe's text (JSON is YAML), which the engine's own reader checks.
RecipeWithSpectra recipeOf(nb::dict fields, const SideArguments& input, const SideArguments& output,
                           const nb::object& adaptation, const std::filesystem::path& folder) {
  RecipeWithSpectra recipe;
  nb::dict outputEntry = sideEntry(output, recipe.output);
  if (!adaptation.is_none()) {
    outputEntry["adaptation"] = adaptation;
  }
  fields["metamer"] = 1;
  fields["input"] = sideEntry(input, recipe.input);
  fields["output"] = outputEntry;
  const auto text = nb::cast<std::string>(nb::module_::import_("json").attr("dumps")(fields));
  recipe.named = sip::parseRecipe(text, "Recipe");
  recipe.named.folder = folder;
  return recipe;
}

using NamedFilters = std::vector<std::pair<std::string, double>>;

NamedFilters filtersOf(const sip::RecipePipeline& pipeline) {
  NamedFilters filters;
  for (const auto& filter : pipeline.filters) {
    filters.emplace_back(filter.name, filter.density);
  }
  return filters;
}

template <typename Binding>
void bindFields(Binding& binding) {
  const auto field = [&](const char* name, const auto& get) {
    binding.def_prop_ro(name, [get](const RecipeWithSpectra& self) { return get(self.named); });
  };
  field("folder", [](const sip::Recipe& recipe) { return spectral::utf8(recipe.folder); });
  field("where", [](const sip::Recipe& recipe) { return recipe.where; });
  field("name", [](const sip::Recipe& recipe) { return recipe.name; });
  field("space", [](const sip::Recipe& recipe) { return recipe.space; });
  field("illuminant_in", [](const sip::Recipe& recipe) { return recipe.input.illuminant; });
  field("illuminant_out", [](const sip::Recipe& recipe) { return recipe.output.illuminant; });
  field("observer_in", [](const sip::Recipe& recipe) { return recipe.input.observer; });
  field("observer_out", [](const sip::Recipe& recipe) { return recipe.output.observer; });
  field("filters_in", [](const sip::Recipe& recipe) { return filtersOf(recipe.input); });
  field("filters_out", [](const sip::Recipe& recipe) { return filtersOf(recipe.output); });
  field("adaptation", [](const sip::Recipe& recipe) { return recipe.adaptation; });
  field("cat", [](const sip::Recipe& recipe) { return spectral::nameOf(recipe.cat); });
  field("keep_exposure", [](const sip::Recipe& recipe) { return recipe.keepExposure; });
}

void construct(RecipeWithSpectra* self, const nb::object& illuminantIn, const nb::object& illuminantOut,
               const nb::object& filtersIn, const nb::object& filtersOut, const nb::object& observerIn,
               const nb::object& observerOut, const nb::object& adaptation, const nb::object& scene,
               const std::filesystem::path& folder, const nb::kwargs& rest) {
  nb::dict fields(rest);
  if (!scene.is_none()) {
    fields["scene"] = scene;
    if (nb::isinstance<nb::str>(scene)) {
      nb::dict kind;
      kind["kind"] = scene;
      fields["scene"] = kind;
    }
  }
  new (self) RecipeWithSpectra(recipeOf(fields, {illuminantIn, filtersIn, observerIn},
                                        {illuminantOut, filtersOut, observerOut}, adaptation, folder));
}

}  // namespace

void bindRecipe(nb::module_& module) {
  nb::class_<RecipeWithSpectra> binding(
      module, "Recipe",
      "What light a picture was shot under and what light it should appear under (docs/recipe.md).\n"
      "Lights, filters and observers are names of the library, files, or spectra.");
  binding
      .def("__init__", &construct, "illuminant_in"_a, "illuminant_out"_a, nb::kw_only(), "filters_in"_a = nb::tuple(),
           "filters_out"_a = nb::tuple(), "observer_in"_a = nb::none(), "observer_out"_a = nb::none(),
           "adaptation"_a = nb::none(), "scene"_a = nb::none(), "folder"_a = "", "fields"_a,
           nb::sig("def __init__(self, illuminant_in: metamer._types.NamedSpectrum, illuminant_out: "
                   "metamer._types.NamedSpectrum, *, filters_in: collections.abc.Iterable[metamer._types.FilterLike] = "
                   "(), filters_out: collections.abc.Iterable[metamer._types.FilterLike] = (), observer_in: "
                   "metamer._types.NamedObserver | None = None, observer_out: metamer._types.NamedObserver | None = "
                   "None, adaptation: float | None = None, scene: str | collections.abc.Mapping[str, object] | None = "
                   "None, folder: str | os.PathLike[str] = '', name: str = 'transform', space: str = 'ACEScg', cat: "
                   "str = 'vonkries', keep_exposure: bool = False) -> None"),
           "The fields of a recipe's file, named as lutgen's options are. `scene` is a kind, or a dict of the scene's\n"
           "fields. Files are relative to `folder`.")
      .def_static(
          "read",
          [](const std::filesystem::path& file) {
            return RecipeWithSpectra{sip::readRecipe(file), {}, {}};
          },
          "file"_a, nb::sig("def read(file: str | os.PathLike[str]) -> Recipe"), "A recipe's file.")
      .def_static(
          "parse",
          [](const std::string& text, const std::filesystem::path& folder) {
            RecipeWithSpectra recipe{sip::parseRecipe(text, "Recipe"), {}, {}};
            recipe.named.folder = folder;
            return recipe;
          },
          "text"_a, nb::kw_only(), "folder"_a = "",
          nb::sig("def parse(text: str, *, folder: str | os.PathLike[str] = '') -> Recipe"), "A recipe's text (YAML).")
      .def(
          "yaml", [](const RecipeWithSpectra& self) { return sip::toYaml(self.named); },
          "The recipe's text with every field. A spectrum that was given in place of a name leaves its name only.")
      .def("__repr__", [](const RecipeWithSpectra& self) {
        return "<metamer.Recipe '" + self.named.name + "', " + self.named.input.illuminant + " to " +
               self.named.output.illuminant + ", " + self.named.space + ">";
      });
  bindFields(binding);
  binding.def_prop_ro("is_named", &RecipeWithSpectra::isNamed, "Whether no spectrum stands in place of a name.");
}

}  // namespace metamer::python
