// SPDX-License-Identifier: Apache-2.0
#include "metamer/spectral/colorimetry.h"

#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>

#include "arrays.h"
#include "bindings.h"
#include "metamer/spectral/correlated_colour_temperature.h"
#include "metamer/spectral/spectral_similarity_index.h"
#include "spectrum_like.h"

using namespace nanobind::literals;

namespace metamer::python {
namespace {

using Colour = Eigen::Map<const Eigen::Vector3d>;

NumpyDoubles tristimulus(nb::handle reflectance, nb::handle light, nb::handle observer) {
  return newVector(spectral::tristimulus(spectrumFrom(reflectance, spectral::SpectralQuantity::Reflectance),
                                         lightFrom(light), namedObserverFrom(observer)));
}

NumpyDoubles response(nb::handle light, nb::handle observer) {
  return newVector(spectral::response(lightFrom(light), namedObserverFrom(observer)));
}

NumpyDoubles lab(nb::handle xyz, nb::handle white) {
  const Doubles colours = doubles(xyz);
  const Eigen::Vector3d whiteXyz = vector3(white, "white");
  return newDoubles(shapeOfColours(colours, "xyz"), [&](double* result) {
    for (std::size_t i = 0; i < colours.size(); i += 3) {
      Eigen::Map<Eigen::Vector3d>(result + i) = spectral::lab(Colour(colours.data() + i), whiteXyz);
    }
  });
}

nb::object deltaE2000(nb::handle lab1, nb::handle lab2) {
  const nb::object both = nb::module_::import_("numpy").attr("broadcast_arrays")(doubles(lab1), doubles(lab2));
  const Doubles first = doubles(nb::object(both[0]));
  const Doubles second = doubles(nb::object(both[1]));
  std::vector<std::size_t> shape = shapeOfColours(first, "lab");
  shape.pop_back();
  const auto difference = [&](std::size_t i) {
    return spectral::deltaE2000(Colour(first.data() + 3 * i), Colour(second.data() + 3 * i));
  };
  if (shape.empty()) {
    return nb::float_(difference(0));
  }
  return newDoubles(shape, [&](double* result) {
    for (std::size_t i = 0; i < first.size() / 3; ++i) {
      result[i] = difference(i);
    }
  });
}

std::pair<double, double> temperature(nb::handle light) {
  const auto observer = libraryOr(nullptr).observer("CIE 1931 2");
  const auto found =
      spectral::correlatedColourTemperature(spectral::response(lightFrom(light), observer), observer.onDomain());
  return {found.cctK, found.duv};
}

double similarity(nb::handle light, nb::handle reference, bool rounded) {
  return spectral::spectralSimilarityIndex(lightFrom(light), lightFrom(reference), rounded);
}

}  // namespace

void bindColorimetry(nb::module_& module) {
  module.def("tristimulus", &tristimulus, "reflectance"_a, "light"_a, "observer"_a = "CIE 1931 2",
             nb::sig("def tristimulus(reflectance: metamer._types.SpectrumLike, light: metamer._types.NamedSpectrum, "
                     "observer: metamer._types.NamedObserver = 'CIE 1931 2') -> "
                     "numpy.typing.NDArray[numpy.float64]"),
             "Response to a reflectance under a light; the perfect reflector has Y = 1.");
  module.def("response", &response, "light"_a, "observer"_a = "CIE 1931 2",
             nb::sig("def response(light: metamer._types.NamedSpectrum, observer: metamer._types.NamedObserver = "
                     "'CIE 1931 2') -> numpy.typing.NDArray[numpy.float64]"),
             "Response to a light, unnormalised: the integral of power times curve.");
  module.def("lab", &lab, "xyz"_a, "white"_a,
             nb::sig("def lab(xyz: numpy.typing.ArrayLike, white: numpy.typing.ArrayLike) -> "
                     "numpy.typing.NDArray[numpy.float64]"),
             "CIELAB of tristimuli (last axis X, Y, Z) relative to a white.");
  module.def("delta_e_2000", &deltaE2000, "lab1"_a, "lab2"_a,
             nb::sig("def delta_e_2000(lab1: numpy.typing.ArrayLike, lab2: numpy.typing.ArrayLike) -> typing.Any"),
             "CIEDE2000 of CIELAB colours: a float for one pair, an array for many.");
  module.def("correlated_colour_temperature", &temperature, "light"_a,
             nb::sig("def correlated_colour_temperature(light: metamer._types.NamedSpectrum) -> tuple[float, float]"),
             "Temperature of the nearest blackbody in kelvin, and Duv, the signed distance to it in CIE 1960 u, v.");
  module.def("spectral_similarity_index", &similarity, "light"_a, "reference"_a, nb::kw_only(), "rounded"_a = true,
             nb::sig("def spectral_similarity_index(light: metamer._types.NamedSpectrum, reference: "
                     "metamer._types.NamedSpectrum, *, rounded: bool = True) -> float"),
             "SMPTE ST 2122 SSI of a light to a reference light, at most 100.");
}

}  // namespace metamer::python
