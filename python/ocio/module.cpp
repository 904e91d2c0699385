// SPDX-License-Identifier: Apache-2.0
// The module metamer._ocio: what metamer.ocio asks of the library ocio_plugin. Recipes come as text, results go as
// plain values, so that nothing of metamer._core is needed here but its Library.
#include <nanobind/nanobind.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "metamer/ocio/bake.h"
#include "metamer/ocio/compared_transform.h"
#include "metamer/ocio/shaper.h"
#include "metamer/ocio/working_space.h"
#include "metamer/spectral/missing_file_error.h"

namespace nb = nanobind;
using namespace nanobind::literals;

namespace metamer::python {
namespace {

using ocio::ComparedTransform;
using spectral::DataLibrary;

/// A recipe's text, what messages call it, and where its files are looked for.
using RecipeText = std::tuple<std::string, std::string, std::filesystem::path>;
/// A config's file, archive or name of OpenColorIO's own; none: $OCIO.
using ConfigName = std::optional<std::string>;

sip::Recipe recipeOf(const RecipeText& given) {
  const auto& [text, where, folder] = given;
  sip::Recipe recipe = sip::parseRecipe(text, where);
  recipe.folder = folder;
  return recipe;
}

ocio::ConfigSource configOf(const ConfigName& name) {
  return name ? ocio::ConfigSource(ocio::configNamed(*name), *name) : ocio::ConfigSource::environment();
}

struct BakeArguments {
  int size = 0;
  bool sampled = false;
  std::optional<std::string> shaper;
  std::optional<double> tolerance;
  std::optional<std::pair<int, int>> stops;
  int shaperSize = 0;
  ConfigName config;
};

ocio::BakeOptions optionsOf(const BakeArguments& arguments) {
  ocio::BakeOptions options;
  options.size = arguments.size;
  options.fitted = !arguments.sampled;
  options.tolerance = arguments.tolerance;
  options.shaperSize = arguments.shaperSize;
  options.config = configOf(arguments.config);
  if (arguments.shaper) {
    options.shaper = ocio::shaperFromName(*arguments.shaper);
  }
  if (arguments.stops) {
    options.lowestStop = arguments.stops->first;
    options.highestStop = arguments.stops->second;
  }
  return options;
}

std::string bakeFile(const RecipeText& recipe, const DataLibrary& library, const std::filesystem::path& file,
                     const std::string& format, const BakeArguments& arguments) {
  const nb::gil_scoped_release released;
  return ocio::bakeFile(recipeOf(recipe), library, file, format, optionsOf(arguments)).json();
}

std::pair<std::string, std::string> bakeText(const RecipeText& recipe, const DataLibrary& library,
                                             const std::string& format, const BakeArguments& arguments) {
  const nb::gil_scoped_release released;
  const auto baked = ocio::bakeText(recipeOf(recipe), library, format, optionsOf(arguments));
  return {baked.text, baked.certificate.json()};
}

using Compared = std::tuple<std::string, std::vector<double>, std::vector<std::string>,
                            std::vector<std::tuple<double, double, double, double>>>;

/// The space; mean, p99 and max; and for every probe at every stop its name, its colour (linear) and the difference.
Compared compare(const ComparedTransform& a, const ComparedTransform& b, const DataLibrary& library) {
  const nb::gil_scoped_release released;
  const spectral::RgbSpace space = ocio::comparisonSpace(a, b);
  const sip::Comparison found = ocio::compareTransforms(a, b, space, library);
  std::vector<std::string> names;
  std::vector<std::tuple<double, double, double, double>> colours;
  for (const auto& colour : found.colours) {
    names.push_back(colour.name);
    colours.emplace_back(colour.rgb[0], colour.rgb[1], colour.rgb[2], colour.deltaE);
  }
  return {space.name, {found.mean, found.p99, found.max}, std::move(names), std::move(colours)};
}

std::vector<std::pair<std::string, std::string>> formats() {
  std::vector<std::pair<std::string, std::string>> names;
  for (const ocio::LutFormat& format : ocio::lutFormats()) {
    names.emplace_back(format.name, format.use);
  }
  return names;
}

void bindComparison(nb::module_& module) {
  nb::class_<ComparedTransform>(module, "ComparedTransform");
  module.def(
      "compared_recipe",
      [](const RecipeText& recipe, const DataLibrary& library, const ConfigName& config) {
        return ocio::comparedRecipe(recipeOf(recipe), library, configOf(config));
      },
      "recipe"_a, "library"_a, "config"_a.none());
  module.def(
      "compared_file",
      [](const std::filesystem::path& file, const std::string& space, const std::string& shaper,
         const DataLibrary& library, const ConfigName& config) {
        return ocio::comparedFile(file, {space, shaper}, library, configOf(config));
      },
      "file"_a, "space"_a, "shaper"_a, "library"_a, "config"_a.none());
  module.def("compared_look", &ocio::comparedLook, "config"_a, "look"_a, "library"_a);
  module.def("compare", &compare, "a"_a, "b"_a, "library"_a);
}

}  // namespace
}  // namespace metamer::python

NB_MODULE(_ocio, module) {
  using namespace metamer::python;
  module.doc() = "What metamer.ocio is made of.";
  nb::register_exception_translator([](const std::exception_ptr& thrown, void* /*payload*/) {
    try {
      std::rethrow_exception(thrown);
    } catch (const metamer::spectral::MissingFileError& error) {
      PyErr_SetString(PyExc_FileNotFoundError, error.what());
    } catch (const metamer::spectral::InputError& error) {
      PyErr_SetString(PyExc_ValueError, error.what());
    }
  });
  nb::module_::import_("metamer._core");  // for its Library
  nb::class_<BakeArguments>(module, "BakeArguments")
      .def(nb::init<>())
      .def_rw("size", &BakeArguments::size)
      .def_rw("sampled", &BakeArguments::sampled)
      .def_rw("shaper", &BakeArguments::shaper, nb::arg().none())
      .def_rw("tolerance", &BakeArguments::tolerance, nb::arg().none())
      .def_rw("stops", &BakeArguments::stops, nb::arg().none())
      .def_rw("shaper_size", &BakeArguments::shaperSize)
      .def_rw("config", &BakeArguments::config, nb::arg().none());
  module.attr("opencolorio_version") = metamer::ocio::OCIO::GetVersion();
  module.def("bake_file", &bakeFile, "recipe"_a, "library"_a, "file"_a, "format"_a, "arguments"_a);
  module.def("bake_text", &bakeText, "recipe"_a, "library"_a, "format"_a, "arguments"_a);
  module.def("formats", &formats);
  bindComparison(module);
}
