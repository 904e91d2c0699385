// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

#include "files/json_text.h"
#include "files/sampled_rows.h"
#include "metamer/spectral/input_error.h"
#include "metamer/spectral/spectral_files.h"
#include "metamer/spectral/text.h"

namespace metamer::spectral {
namespace {

constexpr std::size_t kMostNames = 10'000;

std::vector<std::string> readNames(const nlohmann::json& index, const std::string& where) {
  const nlohmann::json& main = member(index, "main");
  if (!main.is_array() || main.empty() || main.size() > kMostNames) {
    throw InputError(where, "spectral_data.index.main", shortened(valueText(main), 60),
                     "must be a list of names, one a column");
  }
  std::vector<std::string> names;
  for (const nlohmann::json& name : main) {
    if (!name.is_string()) {
      throw InputError(where, "spectral_data.index.main", valueText(name), "must be text in quotes");
    }
    names.push_back(name.get<std::string>());
  }
  return names;
}

/// The units of the schema that contradict what the caller asks for.
void checkUnits(const std::string& units, const std::string& where, SpectralQuantity quantity) {
  constexpr std::array<std::string_view, 4> kPowers{"flux", "radiance", "irradiance", "intensity"};
  const std::string stated = lowerCase(units);
  const bool isPower = std::find(kPowers.begin(), kPowers.end(), stated) != kPowers.end();
  const bool isReflectance = stated == "reflectance";
  const bool isTransmittance = stated == "transmittance";
  const bool fits = (!isPower || quantity == SpectralQuantity::SpectralPowerDistribution) &&
                    (!isReflectance || quantity == SpectralQuantity::Reflectance) &&
                    (!isTransmittance || quantity == SpectralQuantity::Transmittance);
  if (!fits) {
    throw InputError(where, "spectral_data.units", units, "a " + quantityName(quantity) + " is needed here");
  }
}

struct Row {
  double wavelengthNm;
  const nlohmann::json* values;
};

/// Sorted by wavelength: the order of members of a JSON object means nothing.
std::vector<Row> sortedRows(const nlohmann::json& main, const std::string& where) {
  if (!main.is_object() || main.empty()) {
    throw InputError(where, "spectral_data.data.main", "", "must be an object with one member a wavelength");
  }
  std::vector<Row> rows;
  for (const auto& [key, values] : main.items()) {
    rows.push_back({requiredNumber(key, where, "wavelength"), &values});
  }
  std::sort(rows.begin(), rows.end(), [](const Row& a, const Row& b) { return a.wavelengthNm < b.wavelengthNm; });
  return rows;
}

}  // namespace

std::vector<Spectrum> readRawtoacesJson(const std::string& text, const std::string& where, SpectralQuantity quantity) {
  const nlohmann::json document = parseJson(text, where);
  const nlohmann::json& spectralData = member(document, "spectral_data");
  if (!spectralData.is_object()) {
    throw InputError(where, "spectral_data", "", "is missing; a rawtoaces measurement file holds it");
  }
  const std::string units = optionalText(spectralData, "units", where);
  checkUnits(units, where, quantity);

  SampledRows table;
  table.where = where;
  table.names = readNames(member(spectralData, "index"), where);
  table.columns.resize(table.names.size());
  for (const Row& row : sortedRows(member(member(spectralData, "data"), "main"), where)) {
    const std::string rowWhere = where + ": " + numberText(row.wavelengthNm) + " nm";
    if (!row.values->is_array() || row.values->size() != table.names.size()) {
      throw InputError(rowWhere, "values", shortened(valueText(*row.values), 60),
                       "must be a list of " + std::to_string(table.names.size()) + ", one a name of the index");
    }
    for (std::size_t c = 0; c < table.names.size(); ++c) {
      const nlohmann::json& value = (*row.values)[c];
      if (!value.is_number()) {
        throw InputError(rowWhere, "value", valueText(value), "must be a number");
      }
      table.columns[c].push_back(value.get<double>());
    }
    table.wavelengthsNm.push_back(row.wavelengthNm);
  }
  table.rowWhere = [where, wavelengths = table.wavelengthsNm](std::size_t row) {
    return where + ": " + numberText(wavelengths[row]) + " nm";
  };
  const bool percent = units == "%" || lowerCase(units) == "percent";
  return spectraFromRows(std::move(table), quantity, percent ? StatedScale::Percent : StatedScale::NotStated);
}

}  // namespace metamer::spectral
