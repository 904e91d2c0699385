// SPDX-License-Identifier: Apache-2.0
#include "metamer/spectral/spectrum.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "metamer/spectral/input_error.h"
#include "metamer/spectral/spectral_integral.h"
#include "metamer/spectral/text.h"

namespace metamer::spectral {
namespace {

bool endValuesHold(SpectralQuantity quantity) {
  return quantity == SpectralQuantity::Reflectance || quantity == SpectralQuantity::Transmittance;
}

/// Linear between samples i and i + 1. Written so that it returns the samples themselves at their wavelengths.
double between(const std::vector<double>& wavelengths, const std::vector<double>& values, std::size_t i,
               double wavelength) {
  const double t = (wavelength - wavelengths[i]) / (wavelengths[i + 1] - wavelengths[i]);
  return (1.0 - t) * values[i] + t * values[i + 1];
}

std::string atWavelength(const char* what, double wavelengthNm) {
  return std::string(what) + " at " + numberText(wavelengthNm) + " nm";
}

void checkWavelengths(const std::string& name, const std::vector<double>& wavelengths) {
  for (std::size_t i = 0; i < wavelengths.size(); ++i) {
    if (!std::isfinite(wavelengths[i]) || wavelengths[i] <= 0) {
      throw InputError(name, "wavelength", numberText(wavelengths[i]), "must be a finite number of nm above 0");
    }
    if (i > 0 && wavelengths[i] <= wavelengths[i - 1]) {
      throw InputError(name, "wavelength", numberText(wavelengths[i]),
                       "must be above the one before it, " + numberText(wavelengths[i - 1]) + " nm");
    }
  }
}

void checkValues(const std::string& name, SpectralQuantity quantity, const std::vector<double>& wavelengths,
                 const std::vector<double>& values) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!std::isfinite(values[i])) {
      throw InputError(name, atWavelength("value", wavelengths[i]), numberText(values[i]), "must be a finite number");
    }
    if (values[i] < 0 && quantity != SpectralQuantity::Sensitivity) {
      throw InputError(name, atWavelength("value", wavelengths[i]), numberText(values[i]),
                       "must not be negative; set measurement noise below zero to 0");
    }
  }
}

}  // namespace

Spectrum::Spectrum(std::string name, SpectralQuantity quantity, std::vector<double> wavelengthsNm,
                   std::vector<double> values)
    : m_name(std::move(name)),
      m_quantity(quantity),
      m_wavelengthsNm(std::move(wavelengthsNm)),
      m_values(std::move(values)) {
  if (m_wavelengthsNm.size() < 2) {
    throw InputError(m_name, "samples", std::to_string(m_wavelengthsNm.size()), "a spectrum needs at least two");
  }
  if (m_values.size() != m_wavelengthsNm.size()) {
    throw InputError(m_name, "values", std::to_string(m_values.size()),
                     "must be as many as wavelengths, " + std::to_string(m_wavelengthsNm.size()));
  }
  checkWavelengths(m_name, m_wavelengthsNm);
  checkValues(m_name, m_quantity, m_wavelengthsNm, m_values);
}

Spectrum Spectrum::withNotes(std::vector<std::string> notes) const {
  Spectrum noted = *this;
  noted.m_notes = std::move(notes);
  return noted;
}

Spectrum Spectrum::ofFormula() const {
  Spectrum marked = *this;
  marked.m_isOfFormula = true;
  return marked;
}

SpectralShape Spectrum::shape() const {
  SpectralShape shape{m_wavelengthsNm.front(), m_wavelengthsNm.back(), 0};
  const double interval = (shape.endNm - shape.startNm) / static_cast<double>(m_wavelengthsNm.size() - 1);
  // Files carry wavelengths rounded to a few decimals, so equal steps differ by that rounding.
  constexpr double kRoundingNm = 1e-3;
  for (std::size_t i = 0; i < m_wavelengthsNm.size(); ++i) {
    if (std::abs(m_wavelengthsNm[i] - (shape.startNm + interval * static_cast<double>(i))) > kRoundingNm) {
      return shape;
    }
  }
  shape.intervalNm = interval;
  return shape;
}

double Spectrum::at(double wavelengthNm) const {
  const bool below = wavelengthNm < m_wavelengthsNm.front();
  if (below || wavelengthNm > m_wavelengthsNm.back()) {
    const double endValue = below ? m_values.front() : m_values.back();
    return endValuesHold(m_quantity) ? endValue : 0.0;
  }
  const auto above = std::upper_bound(m_wavelengthsNm.begin(), m_wavelengthsNm.end() - 1, wavelengthNm);
  const auto i = static_cast<std::size_t>(above - m_wavelengthsNm.begin());
  return between(m_wavelengthsNm, m_values, i - 1, wavelengthNm);
}

DomainSamples Spectrum::onDomain() const {
  if (m_quantity == SpectralQuantity::SpectralPowerDistribution) {
    return lightOnDomain(*this);
  }
  // As at(), without a search for each: the wavelengths rise on both sides.
  DomainSamples samples;
  std::size_t above = 1;
  for (int i = 0; i < kDomainSize; ++i) {
    const double nm = kDomainStartNm + i;
    if (nm < m_wavelengthsNm.front() || nm > m_wavelengthsNm.back()) {
      samples[i] = at(nm);
      continue;
    }
    while (above + 1 < m_wavelengthsNm.size() && m_wavelengthsNm[above] <= nm) {
      ++above;
    }
    samples[i] = between(m_wavelengthsNm, m_values, above - 1, nm);
  }
  return samples;
}

}  // namespace metamer::spectral
