// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nanobind/nanobind.h>

#include <optional>
#include <string>
#include <vector>

#include "metamer/spectral/observer.h"
#include "metamer/spectral/spectrum.h"

namespace metamer::python {

namespace nb = nanobind;

/// Text of a str or os.PathLike; nothing for any other object.
std::optional<std::string> nameOrFile(nb::handle object);

/// A spectrum of a Spectrum, a mapping from nm to value, or an object with `wavelengths`, `values` and perhaps `name`
/// (colour-science's SpectralDistribution).
/// @throws nb::type_error for any other; spectral::InputError for numbers that make no spectrum; nb::value_error for a
///         Spectrum of another quantity
spectral::Spectrum spectrumFrom(nb::handle object, spectral::SpectralQuantity quantity, const std::string& name = {});

/// An observer of an Observer, or an object with `wavelengths`, three columns of `values`, and perhaps `labels` and
/// `name` (colour-science's MultiSpectralDistributions). @throws as above
spectral::Observer observerFrom(nb::handle object);

/// A light, an observer, a set of reflectances: names of the usual library, files, or as above.
spectral::Spectrum lightFrom(nb::handle light);
spectral::Observer namedObserverFrom(nb::handle observer);
std::vector<spectral::Spectrum> reflectancesFrom(nb::handle reflectances);

/// "power", "sensitivity", "reflectance", "transmittance". @throws nb::value_error for any other name
spectral::SpectralQuantity quantityNamed(const std::string& name);
const char* nameOf(spectral::SpectralQuantity quantity);

/// "xyz", "lms", "camera". @throws nb::value_error for any other name
spectral::Observer::Response responseNamed(const std::string& name);
const char* nameOf(spectral::Observer::Response response);

}  // namespace metamer::python
