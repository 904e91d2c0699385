// SPDX-License-Identifier: Apache-2.0
#include "metamer/spectral/uplift.h"

#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "arrays.h"
#include "bindings.h"
#include "metamer/sip/scene_uplift.h"

using namespace nanobind::literals;

namespace metamer::python {
namespace {

using spectral::Uplift;

/// The class of the module: which method it is of is known when it runs.
struct AnyUplift {
  std::unique_ptr<Uplift> method;
};

std::optional<spectral::UpliftWeights> weightsFrom(nb::handle weights) {
  if (weights.is_none()) {
    return std::nullopt;
  }
  const Doubles array = doubles(weights);
  if (array.ndim() != 2 || array.shape(1) != 3) {
    throw nb::value_error("uplift: weights must be X, Y and Z a wavelength");
  }
  return Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>>(
      array.data(), static_cast<Eigen::Index>(array.shape(0)), 3);
}

NumpyDoubles spectraOf(const AnyUplift& self, nb::handle rgb) {
  const Uplift& uplift = *self.method;
  const Doubles array = doubles(rgb);
  std::vector<std::size_t> shape = shapeOfColours(array, "rgb");
  const std::size_t size = uplift.wavelengthsNm().size();
  shape.back() = size;
  return newDoubles(shape, [&](double* spectra) {
    const nb::gil_scoped_release release;
    uplift.spectra({array.data(), array.size()}, {spectra, array.size() / 3 * size});
  });
}

}  // namespace

void bindUplift(nb::module_& module) {
  nb::class_<AnyUplift>(module, "Uplift",
                        "A way from colours to reflectances: the published 'smits', 'mallett', 'jakob', 'jakob table', "
                        "'otsu', 'meng', and\n"
                        "the scenes 'smooth', 'natural', 'skin' as a recipe takes them under D65.\n"
                        "Colours are linear RGB of Rec.709's primaries, white the perfect reflector under D65.")
      .def(
          "__init__",
          [](AnyUplift* self, const std::string& method, nb::handle weights) {
            new (self) AnyUplift{sip::makeUplift(method, libraryOr(nullptr), weightsFrom(weights))};
          },
          "method"_a, nb::kw_only(), "weights"_a = nb::none(),
          nb::sig("def __init__(self, method: str, *, weights: numpy.typing.ArrayLike | None = None) -> None"),
          "weights: X, Y and Z that each wavelength of the method counts for, the perfect reflector at Y = 1;\n"
          "left out, exact integrals under D65 for the CIE 1931 2° observer. The scenes take none.")
      .def_prop_ro(
          "wavelengths",
          [](const AnyUplift& self) {
            const std::vector<double>& nm = self.method->wavelengthsNm();
            return newVector(Eigen::Map<const Eigen::VectorXd>(nm.data(), static_cast<Eigen::Index>(nm.size())));
          },
          "nm")
      .def_prop_ro(
          "xyz_from_rgb", [](const AnyUplift& self) { return newMatrix(self.method->xyzFromRgb()); },
          "XYZ of a colour as the method takes it; the perfect reflector has Y = 1.")
      .def("__call__", &spectraOf, "rgb"_a,
           nb::sig("def __call__(self, rgb: numpy.typing.ArrayLike) -> numpy.typing.NDArray[numpy.float64]"),
           "Reflectances of colours, shape (..., 3) to (..., wavelengths). Of a colour with NaN, NaN.");
  module.def("uplift_methods", &sip::upliftNames, "What Uplift can be of.");
}

}  // namespace metamer::python
