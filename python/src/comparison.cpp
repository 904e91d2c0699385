// SPDX-License-Identifier: Apache-2.0
#include "metamer/sip/comparison.h"

#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "arrays.h"
#include "bindings.h"
#include "metamer/sip/error_protocol.h"
#include "recipe_with_spectra.h"
#include "transform.h"

using namespace nanobind::literals;

namespace metamer::python {
namespace {

constexpr const char* kChart = "colorchecker";

/// The protocol of a recipe, with what a comparison asks of it again.
struct Protocol {
  std::shared_ptr<const sip::ErrorProtocol> judge;
  sip::ErrorProtocol::Options options;
};

using Candidate = std::function<void(std::span<float> rgba)>;

Candidate inPlace(const PixelFunction& function) {
  return [rgba = function.rgba](std::span<float> pixels) { rgba(pixels, pixels); };
}

/// A Python function of an N x 4 float32 array, which changes it in place or returns another.
Candidate calling(const nb::object& callable) {
  return [callable](std::span<float> rgba) {
    const nb::gil_scoped_acquire held;
    const std::size_t count = rgba.size() / 4;
    using Pixels4 = nb::ndarray<nb::numpy, float>;
    auto memory = std::make_unique<float[]>(rgba.size());
    std::copy(rgba.begin(), rgba.end(), memory.get());
    float* const data = memory.release();
    const nb::capsule owner(data, [](void* pointer) noexcept { delete[] static_cast<float*>(pointer); });
    const nb::object given = nb::cast(Pixels4(data, {count, 4}, owner));
    nb::object result = callable(given);
    if (result.is_none()) {
      result = given;
    }
    const nb::module_ numpy = nb::module_::import_("numpy");
    const auto array = nb::cast<nb::ndarray<const float, nb::c_contig, nb::device::cpu>>(
        numpy.attr("ascontiguousarray")(result, numpy.attr("float32")));
    if (array.ndim() != 2 || array.shape(0) != count || array.shape(1) != 4) {
      throw nb::value_error("candidate: must return pixels of the shape it was given, or change them in place");
    }
    std::copy_n(array.data(), rgba.size(), rgba.data());
  };
}

/// A transform's engine or map on linear pixels; any other callable by calling it.
Candidate candidateOf(const nb::object& object) {
  if (nb::isinstance<Transform>(object)) {
    return inPlace(nb::cast<const Transform&>(object).linearFunction());
  }
  if (nb::isinstance<Map>(object)) {
    return inPlace(nb::cast<const Map&>(object).linearFunction());
  }
  if (!nb::hasattr(object, "__call__")) {
    throw nb::type_error("candidate: must be a metamer.Transform, a metamer.Map, or a function of an N x 4 array");
  }
  return calling(object);
}

Protocol protocolOf(nb::handle recipe, const spectral::DataLibrary* given, int chromaticities, int ring, int lowestStop,
                    int highestStop, bool insideGamutOnly) {
  const spectral::DataLibrary& library = libraryOr(given);
  const RecipeWithSpectra known = recipeFrom(recipe);
  const sip::ErrorProtocol::Options options{chromaticities, ring, lowestStop, highestStop, insideGamutOnly};
  const nb::gil_scoped_release released;
  return {std::make_shared<const sip::ErrorProtocol>(resolve(known, library), library.reflectances(kChart).samples,
                                                     options),
          options};
}

sip::ErrorProtocol::Report measure(const Protocol& self, const nb::object& object, const Transform* against) {
  const Candidate candidate = candidateOf(object);
  const nb::gil_scoped_release released;
  return against == nullptr ? self.judge->measure(candidate) : self.judge->measureAgainst(*against->engine, candidate);
}

sip::Comparison compare(const Protocol& self, const nb::object& a, const nb::object& b) {
  const Candidate first = candidateOf(a);
  const Candidate second = candidateOf(b);
  const nb::gil_scoped_release released;
  return sip::compareTransforms(self.judge->converged().space(), self.judge->probes(), self.options.lowestStop,
                                self.options.highestStop, first, second);
}

NumpyDoubles probeColours(const Protocol& self) {
  const auto& probes = self.judge->probes();
  return newDoubles({probes.size(), 3}, [&](double* data) {
    for (std::size_t i = 0; i < probes.size(); ++i) {
      Eigen::Map<Eigen::Vector3d>(data + 3 * i) = probes[i].rgb;
    }
  });
}

std::vector<std::string> probeNames(const Protocol& self) {
  std::vector<std::string> names;
  for (const auto& probe : self.judge->probes()) {
    names.push_back(probe.name);
  }
  return names;
}

/// The converged engine, which lives in the protocol.
Transform converged(const Protocol& self) {
  return {std::shared_ptr<const sip::SpectralTransform>(self.judge, &self.judge->converged()), std::nullopt};
}

std::string figures(const char* type, double mean, double p99, double max) {
  return std::string("<metamer.") + type + " mean " + std::to_string(mean) + ", p99 " + std::to_string(p99) + ", max " +
         std::to_string(max) + ">";
}

void bindResults(nb::module_& module) {
  using Report = sip::ErrorProtocol::Report;
  nb::class_<Report>(module, "Report", "CIEDE2000 against a reference over the protocol's probes and stops.")
      .def_ro("mean", &Report::mean)
      .def_ro("p99", &Report::p99)
      .def_ro("max", &Report::max)
      .def_ro("count", &Report::count)
      .def_ro("worst_probe", &Report::worstProbe)
      .def_prop_ro("worst_rgb", [](const Report& self) { return newVector(self.worstRgb); })
      .def("__repr__", [](const Report& self) { return figures("Report", self.mean, self.p99, self.max); });
  using Comparison = sip::Comparison;
  nb::class_<Comparison>(module, "Comparison", "CIEDE2000 between two transforms, probe by probe.")
      .def_ro("mean", &Comparison::mean)
      .def_ro("p99", &Comparison::p99)
      .def_ro("max", &Comparison::max)
      .def_prop_ro("worst_rgb",
                   [](const Comparison& self) -> std::optional<NumpyDoubles> {
                     return self.colours.empty() ? std::nullopt
                                                 : std::optional(newVector(self.colours[self.worst].rgb));
                   })
      .def_prop_ro(
          "delta_e",
          [](const Comparison& self) {
            return newDoubles({self.colours.size()}, [&](double* data) {
              std::transform(self.colours.begin(), self.colours.end(), data,
                             [](const sip::ComparedColour& colour) { return colour.deltaE; });
            });
          },
          "Of every probe at every stop; infinite where one result is not finite and the other is.")
      .def_prop_ro(
          "rgb",
          [](const Comparison& self) {
            return newDoubles({self.colours.size(), 3}, [&](double* data) {
              for (std::size_t i = 0; i < self.colours.size(); ++i) {
                Eigen::Map<Eigen::Vector3d>(data + 3 * i) = self.colours[i].rgb;
              }
            });
          },
          "What went in, linear, a row each.")
      .def("__repr__", [](const Comparison& self) { return figures("Comparison", self.mean, self.p99, self.max); });
}

}  // namespace

void bindComparison(nb::module_& module) {
  bindResults(module);
  const sip::ErrorProtocol::Options usual;
  nb::class_<Protocol>(module, "ErrorProtocol",
                       "The one error protocol of certificates and benchmarks (docs/error_protocol.md): probes over\n"
                       "gamut, locus and a chart, at many stops, judged by CIEDE2000 against the converged engine.\n"
                       "Pixels are linear in the recipe's space.")
      .def(
          "__init__",
          [](Protocol* self, nb::handle recipe, const spectral::DataLibrary* library, int chromaticities, int ring,
             int lowestStop, int highestStop, bool insideGamutOnly) {
            new (self)
                Protocol(protocolOf(recipe, library, chromaticities, ring, lowestStop, highestStop, insideGamutOnly));
          },
          "recipe"_a, nb::kw_only(), "library"_a.none() = nb::none(), "chromaticities"_a = usual.chromaticityCount,
          "ring"_a = usual.ringCount, "lowest_stop"_a = usual.lowestStop, "highest_stop"_a = usual.highestStop,
          "inside_gamut_only"_a = usual.insideGamutOnly,
          nb::sig("def __init__(self, recipe: metamer._types.RecipeLike, *, library: Library | None = None, "
                  "chromaticities: int = 1024, ring: int = 96, lowest_stop: int = -10, highest_stop: int = 10, "
                  "inside_gamut_only: bool = False) -> None"))
      .def("measure", &measure, "candidate"_a, nb::kw_only(), "against"_a.none() = nb::none(),
           nb::sig("def measure(self, candidate: metamer._types.Candidate, *, against: Transform | None = None) -> "
                   "Report"),
           "The candidate against the converged engine, or against another transform.")
      .def("compare", &compare, "a"_a, "b"_a,
           nb::sig("def compare(self, a: metamer._types.Candidate, b: metamer._types.Candidate) -> Comparison"),
           "Two candidates over the same probes and stops.")
      .def_prop_ro("probes", &probeColours, "Linear RGB at stop 0, a row a probe.")
      .def_prop_ro("probe_names", &probeNames)
      .def_prop_ro("converged", &converged, "The engine that judges, 401 bands.");
}

}  // namespace metamer::python
