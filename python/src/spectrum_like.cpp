// SPDX-License-Identifier: Apache-2.0
#include "spectrum_like.h"

#include <nanobind/stl/string.h>

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "arrays.h"
#include "bindings.h"
#include "metamer/spectral/observer_of_curves.h"

namespace metamer::python {
namespace {

using spectral::Observer;
using spectral::SpectralQuantity;
using spectral::Spectrum;

constexpr std::array<std::pair<SpectralQuantity, const char*>, 4> kQuantities = {
    {{SpectralQuantity::SpectralPowerDistribution, "power"},
     {SpectralQuantity::Sensitivity, "sensitivity"},
     {SpectralQuantity::Reflectance, "reflectance"},
     {SpectralQuantity::Transmittance, "transmittance"}}};
constexpr std::array<std::pair<Observer::Response, const char*>, 3> kResponses = {
    {{Observer::Response::Xyz, "xyz"}, {Observer::Response::Lms, "lms"}, {Observer::Response::Camera, "camera"}}};

template <typename Table>
auto valueNamed(const Table& table, const std::string& name, const std::string& what) {
  std::string known;
  for (const auto& [value, text] : table) {
    if (name == text) {
      return value;
    }
    known += (known.empty() ? "" : ", ") + std::string(text);
  }
  throw nb::value_error((what + " '" + name + "': must be one of " + known).c_str());
}

template <typename Table, typename Value>
const char* nameIn(const Table& table, Value value) {
  return std::find_if(table.begin(), table.end(), [&](const auto& entry) { return entry.first == value; })->second;
}

std::vector<double> vectorOf(nb::handle numbers, const std::string& what) {
  const Doubles array = doubles(numbers);
  if (array.ndim() != 1) {
    throw nb::value_error((what + ": must be one number a wavelength").c_str());
  }
  return {array.data(), array.data() + array.size()};
}

std::string nameFrom(nb::handle object, const std::string& given, const char* otherwise) {
  if (!given.empty()) {
    return given;
  }
  const nb::object name = nb::getattr(object, "name", nb::none());
  return nb::isinstance<nb::str>(name) ? nb::cast<std::string>(name) : otherwise;
}

Spectrum fromMapping(nb::handle mapping, SpectralQuantity quantity, const std::string& name) {
  std::vector<std::pair<double, double>> samples;
  for (const nb::handle item : mapping.attr("items")()) {
    samples.emplace_back(nb::cast<double>(nb::float_(item[0])), nb::cast<double>(nb::float_(item[1])));
  }
  std::sort(samples.begin(), samples.end());
  std::vector<double> wavelengthsNm;
  std::vector<double> values;
  for (const auto& [wavelengthNm, value] : samples) {
    wavelengthsNm.push_back(wavelengthNm);
    values.push_back(value);
  }
  return {name.empty() ? "spectrum" : name, quantity, std::move(wavelengthsNm), std::move(values)};
}

bool hasSamples(nb::handle object) {
  return nb::hasattr(object, "wavelengths") && nb::hasattr(object, "values");
}

[[noreturn]] void refuse(nb::handle object, const char* what, const char* remedy) {
  throw nb::type_error(
      (std::string(what) + " '" + nb::cast<std::string>(object.type().attr("__name__")) + "': " + remedy).c_str());
}

}  // namespace

std::optional<std::string> nameOrFile(nb::handle object) {
  if (nb::isinstance<nb::str>(object)) {
    return nb::cast<std::string>(object);
  }
  if (nb::hasattr(object, "__fspath__")) {
    return nb::cast<std::string>(nb::str(object.attr("__fspath__")()));
  }
  return std::nullopt;
}

Spectrum spectrumFrom(nb::handle object, SpectralQuantity quantity, const std::string& name) {
  if (nb::isinstance<Spectrum>(object)) {
    const auto& spectrum = nb::cast<const Spectrum&>(object);
    if (spectrum.quantity() != quantity) {
      throw nb::value_error(("spectrum '" + spectrum.name() + "': is a " + nameOf(spectrum.quantity()) + "; a " +
                             nameOf(quantity) + " is needed here")
                                .c_str());
    }
    return name.empty() ? spectrum : Spectrum(name, quantity, spectrum.wavelengthsNm(), spectrum.values());
  }
  // Before `values`, which a mapping has too.
  if (nb::hasattr(object, "items")) {
    return fromMapping(object, quantity, name);
  }
  if (hasSamples(object)) {
    return {nameFrom(object, name, "spectrum"), quantity, vectorOf(object.attr("wavelengths"), "wavelengths"),
            vectorOf(object.attr("values"), "values")};
  }
  refuse(object, "spectrum",
         "must be a metamer.Spectrum, a dict from nm to value, or an object with wavelengths and values");
}

Observer observerFrom(nb::handle object) {
  if (nb::isinstance<Observer>(object)) {
    return nb::cast<Observer>(object);
  }
  if (!hasSamples(object)) {
    refuse(object, "observer",
           "must be a name, a metamer.Observer, or an object with wavelengths and three values each");
  }
  const std::vector<double> wavelengthsNm = vectorOf(object.attr("wavelengths"), "wavelengths");
  const Doubles values = doubles(object.attr("values"));
  if (values.ndim() != 2 || values.shape(0) != wavelengthsNm.size() || values.shape(1) != 3) {
    throw nb::value_error("observer: values must have a row a wavelength and three columns");
  }
  std::vector<std::string> labels = {"red", "green", "blue"};
  if (nb::hasattr(object, "labels") && nb::len(nb::handle(nb::object(object.attr("labels")))) == 3) {
    labels.clear();
    for (const nb::handle label : object.attr("labels")) {
      labels.push_back(nb::cast<std::string>(nb::str(label)));
    }
  }
  std::vector<Spectrum> curves;
  for (std::size_t channel = 0; channel < 3; ++channel) {
    std::vector<double> column;
    for (std::size_t row = 0; row < wavelengthsNm.size(); ++row) {
      column.push_back(values.data()[3 * row + channel]);
    }
    curves.emplace_back(labels[channel], SpectralQuantity::Sensitivity, wavelengthsNm, std::move(column));
  }
  return spectral::observerOfCurves(nameFrom(object, {}, "observer"), curves);
}

Spectrum lightFrom(nb::handle light) {
  const auto name = nameOrFile(light);
  return name ? libraryOr(nullptr).illuminant(*name) : spectrumFrom(light, SpectralQuantity::SpectralPowerDistribution);
}

Observer namedObserverFrom(nb::handle observer) {
  const auto name = nameOrFile(observer);
  return name ? libraryOr(nullptr).observer(*name) : observerFrom(observer);
}

std::vector<Spectrum> reflectancesFrom(nb::handle reflectances) {
  if (const auto set = nameOrFile(reflectances)) {
    return libraryOr(nullptr).reflectances(*set).samples;
  }
  std::vector<Spectrum> samples;
  for (const nb::handle sample : reflectances) {
    samples.push_back(spectrumFrom(sample, SpectralQuantity::Reflectance));
  }
  return samples;
}

SpectralQuantity quantityNamed(const std::string& name) {
  return valueNamed(kQuantities, name, "quantity");
}
const char* nameOf(SpectralQuantity quantity) {
  return nameIn(kQuantities, quantity);
}
Observer::Response responseNamed(const std::string& name) {
  return valueNamed(kResponses, name, "response");
}
const char* nameOf(Observer::Response response) {
  return nameIn(kResponses, response);
}

}  // namespace metamer::python
