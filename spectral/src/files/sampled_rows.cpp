// SPDX-License-Identifier: Apache-2.0
#include "files/sampled_rows.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "metamer/spectral/input_error.h"
#include "metamer/spectral/text.h"

namespace metamer::spectral {
namespace {

/// Fluorescent samples and calibration noise reach a little above 1; nothing measured lies between 1.2 and 2.
constexpr double kHighestUnity = 1.2;
constexpr double kLowestPercent = 2.0;
constexpr double kHighestPercent = 200.0;

bool isRatio(SpectralQuantity quantity) {
  return quantity == SpectralQuantity::Reflectance || quantity == SpectralQuantity::Transmittance;
}

/// True where the wavelengths fall from row to row.
bool checkedFalling(const SampledRows& rows) {
  const std::vector<double>& nm = rows.wavelengthsNm;
  if (nm.empty()) {
    throw InputError(rows.where, "rows", "", "no rows of numbers; a wavelength and a value a row are needed");
  }
  if (nm.size() == 1) {
    throw InputError(rows.where, "rows", "", "only one row of numbers; a spectrum needs at least two");
  }
  const bool falling = nm[1] < nm[0];
  for (std::size_t i = 0; i < nm.size(); ++i) {
    if (!(nm[i] > 0)) {
      throw InputError(rows.rowWhere(i), "wavelength", numberText(nm[i]), "must be above 0");
    }
    if (i > 0 && nm[i] == nm[i - 1]) {
      throw InputError(rows.rowWhere(i), "wavelength", numberText(nm[i]), "appears twice; keep one row");
    }
    if (i > 0 && (nm[i] < nm[i - 1]) != falling) {
      throw InputError(rows.rowWhere(i), "wavelength", numberText(nm[i]),
                       "breaks the order of the rows before it; sort the rows by wavelength");
    }
  }
  const auto [least, most] = std::minmax(nm.front(), nm.back());
  if (most < kDomainStartNm || least > kDomainEndNm) {
    throw InputError(rows.where, "wavelengths", numberText(least) + " to " + numberText(most),
                     "no part lies within 380 to 780 nm; name the unit in the header where it is um or angstrom");
  }
  return falling;
}

void checkNonNegative(const SampledRows& rows, SpectralQuantity quantity) {
  if (quantity == SpectralQuantity::Sensitivity) {
    return;
  }
  for (std::size_t c = 0; c < rows.columns.size(); ++c) {
    const auto negative = std::find_if(rows.columns[c].begin(), rows.columns[c].end(), [](double v) { return v < 0; });
    if (negative != rows.columns[c].end()) {
      throw InputError(rows.rowWhere(static_cast<std::size_t>(negative - rows.columns[c].begin())),
                       quantityName(quantity), numberText(*negative),
                       "must not be negative; set measurement noise below zero to 0");
    }
  }
}

/// Divisor that turns the values into 0 ... 1.
double checkedDivisor(const SampledRows& rows, SpectralQuantity quantity, StatedScale scale) {
  if (!isRatio(quantity) || scale == StatedScale::Unity) {
    return 1;
  }
  double most = 0;
  std::size_t mostRow = 0;
  for (const std::vector<double>& column : rows.columns) {
    const auto highest = std::max_element(column.begin(), column.end());
    if (*highest > most) {
      most = *highest;
      mostRow = static_cast<std::size_t>(highest - column.begin());
    }
  }
  if (most > kHighestPercent) {
    throw InputError(rows.rowWhere(mostRow), quantityName(quantity), numberText(most),
                     "is neither a ratio of 0 to 1 nor percent");
  }
  if (scale == StatedScale::Percent || most > kLowestPercent) {
    return 100;
  }
  if (most > kHighestUnity) {
    throw InputError(rows.rowWhere(mostRow), quantityName(quantity), numberText(most),
                     "could be a ratio or percent; scale it to 0 to 1, or write % in the header");
  }
  return 1;
}

}  // namespace

double requiredNumber(std::string_view token, const std::string& where, const std::string& field) {
  const std::optional<double> number = parseNumber(token);
  if (number) {
    return *number;
  }
  token = trimmed(token);
  if (token.empty()) {
    throw InputError(where, field, "", "is empty; give a number or remove the row");
  }
  if (isNotFinite(token)) {
    throw InputError(where, field, std::string(token), "must be a finite number; remove the row or give its value");
  }
  throw InputError(where, field, std::string(token), "must be a number such as 0.25 or 2.5e-1");
}

std::vector<Spectrum> spectraFromRows(SampledRows rows, SpectralQuantity quantity, StatedScale scale) {
  const bool falling = checkedFalling(rows);
  checkNonNegative(rows, quantity);
  const double divisor = checkedDivisor(rows, quantity, scale);
  if (falling) {
    std::reverse(rows.wavelengthsNm.begin(), rows.wavelengthsNm.end());
  }
  std::vector<Spectrum> spectra;
  spectra.reserve(rows.columns.size());
  for (std::size_t c = 0; c < rows.columns.size(); ++c) {
    std::vector<double>& values = rows.columns[c];
    if (falling) {
      std::reverse(values.begin(), values.end());
    }
    for (double& value : values) {
      value /= divisor;
    }
    spectra.emplace_back(rows.names[c], quantity, rows.wavelengthsNm, std::move(values));
  }
  return spectra;
}

std::string stemOf(const std::string& where) {
  std::string stem = std::filesystem::path(where).stem().string();
  return stem.empty() ? "spectrum" : stem;
}

std::string quantityName(SpectralQuantity quantity) {
  switch (quantity) {
    case SpectralQuantity::SpectralPowerDistribution:
      return "spectral power distribution";
    case SpectralQuantity::Sensitivity:
      return "sensitivity";
    case SpectralQuantity::Reflectance:
      return "reflectance";
    case SpectralQuantity::Transmittance:
      return "transmittance";
  }
  return {};
}

}  // namespace metamer::spectral
