// SPDX-License-Identifier: Apache-2.0
#include "transform.h"

#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>

#include <algorithm>
#include <utility>

#include "arrays.h"
#include "bindings.h"
#include "encoded_pixels.h"
#include "recipe_with_spectra.h"

using namespace nanobind::literals;

namespace metamer::python {
namespace {

void copy(std::span<const float> source, std::span<float> destination) {
  if (source.data() != destination.data()) {
    std::copy(source.begin(), source.end(), destination.begin());
  }
}

Transform transformOf(nb::handle recipe, int bands, const spectral::DataLibrary* given) {
  const spectral::DataLibrary& library = libraryOr(given);
  const RecipeWithSpectra known = recipeFrom(recipe);
  const nb::gil_scoped_release released;
  return {std::make_shared<const sip::SpectralTransform>(resolve(known, library), bands),
          library.colourSpace(known.named.space).encoding};
}

Map mapOf(const Transform& transform, double tolerance) {
  const nb::gil_scoped_release released;
  return {sip::buildHomogeneousMap(*transform.engine, tolerance), transform.encoding};
}

std::pair<NumpyDoubles, NumpyDoubles> linearise(const Transform& transform, nb::handle rgb) {
  const auto near = transform.engine->linearise(vector3(rgb, "rgb"));
  return {newVector(near.value), newMatrix(near.matrix)};
}

NumpyDoubles reflectance(const Transform& transform, nb::handle rgb) {
  return newVector(transform.engine->reflectance(vector3(rgb, "rgb")));
}

NumpyDoubles bandCentres(const Transform& transform) {
  return newVector(
      Eigen::VectorXd::LinSpaced(transform.engine->bandCount(), spectral::kDomainStartNm, spectral::kDomainEndNm));
}

nb::dict diagnostics(const Transform& transform) {
  const auto found = transform.engine->diagnostics();
  nb::dict result;
  result["condition_number"] = found.conditionNumber;
  result["gain"] = found.gain;
  result["relaxation"] = found.relaxation;
  result["reach_up"] = found.reachUp;
  result["reach_down"] = found.reachDown;
  result["reach_aside"] = found.reachAside;
  result["limited_share"] = found.limitedShare;
  return result;
}

constexpr const char* kCall =
    "Pixels of the recipe's space to pixels of the same space: any number of axes, the last RGB or RGBA, any\n"
    "strides; alpha goes along as it is. float32 as lutgen apply does it, float64 in double precision. The result is\n"
    "a new array, or `out`: `pixels` itself (in place) or an array of the same type and shape. Other threads run\n"
    "meanwhile. A pixel with a NaN or infinite component comes back unchanged.";

}  // namespace

PixelFunction Transform::linearFunction() const {
  return {[engine = engine](std::span<const float> source, std::span<float> destination) {
            copy(source, destination);
            engine->apply(destination);
          },
          [engine = engine](std::span<Eigen::Vector3d> colours) { engine->apply(colours); }};
}

PixelFunction Transform::function() const {
  return onEncoded(linearFunction(), engine->isIdentity() ? std::nullopt : encoding);
}

void bindTransform(nb::module_& module) {
  bindMap(module);
  nb::class_<Transform> binding(module, "Transform",
                                "A recipe as a function of pixels: every pixel solved, no table between.\n"
                                "Immutable; safe to share between threads.");
  binding.def(
      "__init__",
      [](Transform* self, nb::handle recipe, int bands, const spectral::DataLibrary* library) {
        new (self) Transform(transformOf(recipe, bands, library));
      },
      "recipe"_a, nb::kw_only(), "bands"_a = sip::kDefaultBandCount, "library"_a.none() = nb::none(),
      nb::sig(("def __init__(self, recipe: metamer._types.RecipeLike, *, bands: int = " +
               std::to_string(sip::kDefaultBandCount) + ", library: Library | None = None) -> None")
                  .c_str()),
      "A recipe or its file. `bands`: 16 to 401, that is, converged.");
  defineCall(
      binding, [](const Transform& self) { return self.function(); }, kCall);
  binding
      .def("map", &mapOf, "tolerance"_a = sip::kDefaultMapTolerance,
           "The transform as a table over directions of RGB: much faster, within `tolerance` CIEDE2000 at the points\n"
           "that are checked.")
      .def_prop_ro("is_identity", [](const Transform& self) { return self.engine->isIdentity(); })
      .def_prop_ro("bands", [](const Transform& self) { return self.engine->bandCount(); })
      .def_prop_ro("wavelengths", &bandCentres, "Centres of the bands, nm.")
      .def_prop_ro(
          "matrix", [](const Transform& self) { return newMatrix(self.engine->linearMatrix()); },
          "3 x 3, on linear RGB: the transform of the smooth scene where no bound and no limit bites.")
      .def("linearise", &linearise, "rgb"_a,
           nb::sig("def linearise(self, rgb: numpy.typing.ArrayLike) -> tuple[numpy.typing.NDArray[numpy.float64], "
                   "numpy.typing.NDArray[numpy.float64]]"),
           "Result for a linear colour, and the transform's derivative there, 3 x 3.")
      .def("reflectance", &reflectance, "rgb"_a,
           nb::sig("def reflectance(self, rgb: numpy.typing.ArrayLike) -> numpy.typing.NDArray[numpy.float64]"),
           "The spectrum given to a linear colour, at `wavelengths`: below zero where no reflectance makes the colour.")
      .def_prop_ro(
          "response_from_rgb", [](const Transform& self) { return newMatrix(self.engine->responseFromRgb()); },
          "3 x 3: the input side's response from linear RGB, white at (1, 1, 1).")
      .def_prop_ro(
          "white_xyz", [](const Transform& self) { return newVector(self.engine->whiteXyz()); },
          "White of the working space, Y = 1.")
      .def_prop_ro("diagnostics", &diagnostics, nb::sig("def diagnostics(self) -> dict[str, float]"),
                   "`condition_number` of the input weights, `gain` (95th percentile over measured surfaces), "
                   "`relaxation` (0: colours\n"
                   "are met exactly), `reach_up`, `reach_down`, `reach_aside` (limits round plain adaptation) and\n"
                   "`limited_share` of the surfaces.");
}

}  // namespace metamer::python
