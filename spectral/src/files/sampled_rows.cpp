// SPDX-License-Identifier: Apache-2.0
#include "files/sampled_rows.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "files/usable_curve.h"
#include "metamer/spectral/input_error.h"
#include "metamer/spectral/path_text.h"
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

/// Rows by rising wavelength; messages keep the rows of the file.
void turnRound(SampledRows& rows) {
  const std::size_t last = rows.wavelengthsNm.size() - 1;
  std::reverse(rows.wavelengthsNm.begin(), rows.wavelengthsNm.end());
  for (std::vector<double>& column : rows.columns) {
    std::reverse(column.begin(), column.end());
  }
  std::map<std::pair<std::size_t, std::size_t>, std::string> flaws;
  for (auto& [place, text] : rows.flaws) {
    flaws.emplace(std::pair(last - place.first, place.second), std::move(text));
  }
  rows.flaws = std::move(flaws);
  rows.rowWhere = [where = std::move(rows.rowWhere), last](std::size_t row) { return where(last - row); };
}

/// Divisor that turns the values into 0 ... 1.
double checkedDivisor(const SampledRows& rows, const std::vector<UsableCurve>& curves, SpectralQuantity quantity,
                      StatedScale scale) {
  if (!isRatio(quantity) || scale == StatedScale::Unity) {
    return 1;
  }
  double most = 0;
  std::size_t mostRow = 0;
  for (const UsableCurve& curve : curves) {
    for (std::size_t i = curve.firstUsed; i <= curve.lastUsed; ++i) {
      if (curve.values[i] > most) {
        most = curve.values[i];
        mostRow = curve.rows[i];
      }
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

SampledRows columnsOf(SampledRows rows, const std::vector<std::size_t>& kept) {
  SampledRows taken;
  for (std::size_t k = 0; k < kept.size(); ++k) {
    taken.names.push_back(std::move(rows.names[kept[k]]));
    taken.columns.push_back(std::move(rows.columns[kept[k]]));
    for (std::size_t row = 0; row < rows.wavelengthsNm.size() && !rows.flaws.empty(); ++row) {
      if (const auto flaw = rows.flaws.find({row, kept[k]}); flaw != rows.flaws.end()) {
        taken.flaws.emplace(std::pair(row, k), flaw->second);
      }
    }
  }
  taken.where = std::move(rows.where);
  taken.wavelengthsNm = std::move(rows.wavelengthsNm);
  taken.rowWhere = std::move(rows.rowWhere);
  return taken;
}

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
  if (checkedFalling(rows)) {
    turnRound(rows);
  }
  std::vector<UsableCurve> curves;
  curves.reserve(rows.columns.size());
  for (std::size_t c = 0; c < rows.columns.size(); ++c) {
    curves.push_back(usableCurve(rows, c, quantity));
  }
  const double divisor = checkedDivisor(rows, curves, quantity, scale);
  std::vector<Spectrum> spectra;
  spectra.reserve(curves.size());
  for (std::size_t c = 0; c < curves.size(); ++c) {
    for (double& value : curves[c].values) {
      value /= divisor;
    }
    spectra.push_back(Spectrum(rows.names[c], quantity, std::move(curves[c].wavelengthsNm), std::move(curves[c].values))
                          .withNotes(std::move(curves[c].notes)));
  }
  return spectra;
}

std::string stemOf(const std::string& where) {
  std::string stem = utf8(pathOf(where).stem());
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
