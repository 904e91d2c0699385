// SPDX-License-Identifier: Apache-2.0
#include <nanobind/stl/array.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "arrays.h"
#include "bindings.h"
#include "metamer/spectral/spectral_files.h"
#include "spectrum_like.h"

using namespace nanobind::literals;

namespace metamer::python {
namespace {

using spectral::Observer;
using spectral::Spectrum;

std::vector<double> listOf(nb::handle numbers) {
  const Doubles array = doubles(numbers);
  if (array.ndim() != 1) {
    throw nb::value_error("spectrum: wavelengths and values must be one number a sample");
  }
  return {array.data(), array.data() + array.size()};
}

nb::object valuesAt(const Spectrum& spectrum, nb::handle wavelengthsNm) {
  const Doubles array = doubles(wavelengthsNm);
  if (array.ndim() == 0) {
    return nb::float_(spectrum.at(*array.data()));
  }
  const std::vector<std::size_t> shape(array.shape_ptr(), array.shape_ptr() + array.ndim());
  return newDoubles(shape, [&](double* values) {
    for (std::size_t i = 0; i < array.size(); ++i) {
      values[i] = spectrum.at(array.data()[i]);
    }
  });
}

Observer observerFromCurves(const std::string& name, const nb::sequence& curves, const std::string& response,
                            const nb::object& xyzFromResponse) {
  if (nb::len(curves) != 3) {
    throw nb::value_error("observer: must have three curves");
  }
  std::vector<Spectrum> spectra;
  for (const nb::handle curve : curves) {
    spectra.push_back(spectrumFrom(curve, spectral::SpectralQuantity::Sensitivity));
  }
  Observer observer{name, responseNamed(response), {spectra[0], spectra[1], spectra[2]}, {}};
  if (observer.response == Observer::Response::Xyz) {
    observer.xyzFromResponse = Eigen::Matrix3d::Identity();
  }
  if (!xyzFromResponse.is_none()) {
    const Doubles matrix = doubles(xyzFromResponse);
    if (matrix.ndim() != 2 || matrix.shape(0) != 3 || matrix.shape(1) != 3) {
      throw nb::value_error("observer: xyz_from_response must be 3 x 3");
    }
    observer.xyzFromResponse = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(matrix.data());
  }
  return observer;
}

std::string representation(const Spectrum& spectrum) {
  const auto& wavelengthsNm = spectrum.wavelengthsNm();
  return "<metamer.Spectrum '" + spectrum.name() + "', " + nameOf(spectrum.quantity()) + ", " +
         std::to_string(wavelengthsNm.size()) + " samples>";
}

}  // namespace

void bindSpectra(nb::module_& module) {
  nb::class_<Spectrum>(module, "Spectrum",
                       "Samples over wavelengths in nm, strictly rising. Linear between samples; outside them a\n"
                       "power or sensitivity is zero, a reflectance or transmittance holds its end values.")
      .def(
          "__init__",
          [](Spectrum* self, nb::handle wavelengthsNm, nb::handle values, const std::string& quantity,
             const std::string& name) {
            new (self) Spectrum(name, quantityNamed(quantity), listOf(wavelengthsNm), listOf(values));
          },
          "wavelengths"_a, "values"_a, nb::kw_only(), "quantity"_a, "name"_a = "spectrum",
          nb::sig("def __init__(self, wavelengths: numpy.typing.ArrayLike, values: numpy.typing.ArrayLike, *, "
                  "quantity: metamer._types.Quantity, name: str = 'spectrum') -> None"))
      .def_static(
          "of",
          [](nb::handle data, const std::string& quantity, const std::string& name) {
            return spectrumFrom(data, quantityNamed(quantity), name);
          },
          "data"_a, nb::kw_only(), "quantity"_a, "name"_a = "",
          nb::sig("def of(data: metamer._types.SpectrumLike, *, quantity: metamer._types.Quantity, name: str = '') -> "
                  "Spectrum"),
          "From a dict {nm: value}, or an object with wavelengths and values (colour-science's SpectralDistribution).")
      .def_static(
          "read",
          [](const std::filesystem::path& file, const std::string& quantity) {
            return spectral::readSpectralFile(file, quantityNamed(quantity));
          },
          "file"_a, nb::kw_only(), "quantity"_a,
          nb::sig("def read(file: str | os.PathLike[str], *, quantity: metamer._types.Quantity) -> list[Spectrum]"),
          "The spectra of a file, one a curve: tables as meters write them, CGATS, IES TM-27 .spdx, rawtoaces "
          ".json. FILE:COLUMN is one of them.")
      .def_prop_ro("name", [](const Spectrum& self) { return self.name(); })
      .def_prop_ro(
          "quantity", [](const Spectrum& self) { return nameOf(self.quantity()); },
          nb::sig("def quantity(self) -> metamer._types.Quantity"))
      .def_prop_ro(
          "wavelengths",
          [](const Spectrum& self) {
            return newVector(Eigen::Map<const Eigen::VectorXd>(self.wavelengthsNm().data(),
                                                               static_cast<Eigen::Index>(self.wavelengthsNm().size())));
          },
          "nm; a copy")
      .def_prop_ro(
          "values",
          [](const Spectrum& self) {
            return newVector(Eigen::Map<const Eigen::VectorXd>(self.values().data(),
                                                               static_cast<Eigen::Index>(self.values().size())));
          },
          "a copy")
      .def("__call__", &valuesAt, "wavelength"_a,
           nb::sig("def __call__(self, wavelength: numpy.typing.ArrayLike) -> typing.Any"),
           "Values at one wavelength (a float) or an array of them, nm.")
      .def("__len__", [](const Spectrum& self) { return self.values().size(); })
      .def("__repr__", &representation);

  nb::class_<Observer>(module, "Observer", "Three response curves: an eye's or a camera's.")
      .def(
          "__init__",
          [](Observer* self, const nb::sequence& curves, const std::string& response, const nb::object& matrix,
             const std::string& name) { new (self) Observer(observerFromCurves(name, curves, response, matrix)); },
          "curves"_a, nb::kw_only(), "response"_a = "camera", "xyz_from_response"_a = nb::none(), "name"_a = "observer",
          nb::sig("def __init__(self, curves: collections.abc.Sequence[metamer._types.SpectrumLike], *, response: "
                  "metamer._types.Response = 'camera', xyz_from_response: numpy.typing.ArrayLike | None = None, name: "
                  "str = 'observer') -> None"),
          "Curves in the order of the response: X, Y, Z; L, M, S; red, green, blue. Without a matrix to XYZ a\n"
          "camera's is solved for the light at hand.")
      .def_static("of", &observerFrom, "data"_a, nb::sig("def of(data: metamer._types.ObserverLike) -> Observer"),
                  "From an object with wavelengths and three columns of values (colour-science's\n"
                  "MultiSpectralDistributions); labels such as x_bar say that it is an eye.")
      .def_prop_ro("name", [](const Observer& self) { return self.name; })
      .def_prop_ro(
          "response", [](const Observer& self) { return nameOf(self.response); },
          nb::sig("def response(self) -> metamer._types.Response"))
      .def_prop_ro("curves",
                   [](const Observer& self) { return std::vector<Spectrum>(self.curves.begin(), self.curves.end()); })
      .def_prop_ro("xyz_from_response",
                   [](const Observer& self) -> std::optional<NumpyDoubles> {
                     return self.xyzFromResponse ? std::optional(newMatrix(*self.xyzFromResponse)) : std::nullopt;
                   })
      .def("__repr__", [](const Observer& self) {
        return "<metamer.Observer '" + self.name + "', " + nameOf(self.response) + ">";
      });
}

}  // namespace metamer::python
