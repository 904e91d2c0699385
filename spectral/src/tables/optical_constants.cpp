// SPDX-License-Identifier: Apache-2.0
#include "metamer/spectral/optical_constants.h"

#include <algorithm>
#include <map>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "files/sampled_rows.h"
#include "metamer/spectral/input_error.h"
#include "metamer/spectral/path_text.h"
#include "metamer/spectral/spectral_files.h"
#include "metamer/spectral/text.h"
#include "tables/layouts.h"
#include "tables/text_encoding.h"

namespace metamer::spectral {
namespace {

/// No table in nm ends below this, none in micrometres begins above.
constexpr double kMostMicrometres = 100;

const char* nameOf(OpticalConstant part) {
  return part == OpticalConstant::Refraction ? "n" : "k";
}

/// Which part a heading names: "n", "eta", "n (Ag)", "k", "kappa", "extinction coefficient".
std::optional<OpticalConstant> partNamed(const std::string& heading) {
  const std::string name = lowerCase(heading);
  const std::string word = name.substr(0, name.find_first_of(" ([_,"));
  if (word == "n" || word == "eta" || word.substr(0, 9) == "refractiv" || word == "re") {
    return OpticalConstant::Refraction;
  }
  if (word == "k" || word == "kappa" || word == "extinction" || word == "im") {
    return OpticalConstant::Extinction;
  }
  return std::nullopt;
}

std::size_t indentOf(std::string_view line) {
  return std::min(line.find_first_not_of(" -"), line.size());
}

/// What stands behind "key:" of a line, or nothing.
std::optional<std::string> valueOf(std::string_view line, std::string_view key) {
  line.remove_prefix(indentOf(line));
  const bool isIt = line.substr(0, key.size()) == key && line.substr(key.size(), 1) == ":";
  return isIt ? std::optional(std::string(trimmed(line.substr(key.size() + 1)))) : std::nullopt;
}

/// A table of a YAML file: "tabulated nk", and its rows.
struct YamlTable {
  std::string type;
  std::string rows;
};

/// The items of DATA in the plain form that refractiveindex.info writes: a type, then "data: |" with rows further in.
std::vector<YamlTable> yamlTables(std::string_view text) {
  std::vector<YamlTable> tables;
  std::optional<std::size_t> dataIndent;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (trimmed(line).empty()) {
      continue;
    }
    if (dataIndent && indentOf(line) > *dataIndent) {
      tables.back().rows += std::string(trimmed(line)) + "\n";
      continue;
    }
    dataIndent.reset();
    if (const auto type = valueOf(line, "type")) {
      tables.push_back({*type, ""});
    } else if (valueOf(line, "data") && !tables.empty()) {
      dataIndent = indentOf(line);
    }
  }
  return tables;
}

/// The curves of a YAML file's tables: wavelength in micrometres, then n, k or both.
std::vector<TableCurves> tabulated(const std::string& text, const std::string& where) {
  std::vector<TableCurves> all;
  std::vector<std::string> types;
  for (const YamlTable& table : yamlTables(text)) {
    types.push_back(table.type);
    const bool isTable = table.type == "tabulated n" || table.type == "tabulated k" || table.type == "tabulated nk";
    if (!isTable || table.rows.empty()) {
      continue;
    }
    const bool hasBoth = table.type == "tabulated nk";
    const std::string csv =
        "um " + (hasBoth ? std::string("n k") : table.type.substr(table.type.size() - 1)) + "\n" + table.rows;
    for (TableCurves& curves : readTable(tableText(csv, where))) {
      all.push_back(std::move(curves));
    }
  }
  if (all.empty()) {
    throw InputError(where, "DATA.type", joined(types),
                     "is no table; download the material's n and k as CSV, which is tabulated for every material");
  }
  return all;
}

/// The one column that is wanted: by its name, else the only one there is.
struct Choice {
  TableCurves* curves = nullptr;
  std::size_t column = 0;
};

Choice choose(std::vector<TableCurves>& all, const std::string& where, OpticalConstant part) {
  Choice named;
  Choice any;
  std::size_t count = 0;
  std::vector<std::string> names;
  for (TableCurves& curves : all) {
    for (std::size_t c = 0; c < curves.rows.columns.size(); ++c) {
      names.push_back(curves.rows.names[c]);
      const std::optional<OpticalConstant> said = partNamed(names.back());
      if (said == part && named.curves == nullptr) {
        named = {&curves, c};
      }
      if (!said) {
        any = {&curves, c};
      }
      ++count;
    }
  }
  if (named.curves != nullptr) {
    return named;
  }
  if (count != 1 || any.curves == nullptr) {
    throw InputError(where, nameOf(part), joined(names),
                     std::string("is not among these columns; name one '") + nameOf(part) + "' in the header");
  }
  return any;
}

}  // namespace

Spectrum opticalConstantFrom(const std::string& text, bool isYaml, const std::string& where, OpticalConstant part) {
  const std::string utf8 = decodedTable(text, where);
  std::vector<TableCurves> all = isYaml ? tabulated(utf8, where) : readTable(tableText(utf8, where));
  const Choice choice = choose(all, where, part);
  SampledRows rows = std::move(choice.curves->rows);
  std::map<std::pair<std::size_t, std::size_t>, std::string> flaws;
  for (auto& [place, flaw] : rows.flaws) {
    if (place.second == choice.column) {
      flaws.emplace(std::pair(place.first, std::size_t{0}), std::move(flaw));
    }
  }
  rows.flaws = std::move(flaws);
  rows.columns = {std::move(rows.columns[choice.column])};
  rows.names = {nameOf(part)};
  const auto most = std::max_element(rows.wavelengthsNm.begin(), rows.wavelengthsNm.end());
  if (!choice.curves->unitStated && most != rows.wavelengthsNm.end() && *most < kMostMicrometres) {
    for (double& nm : rows.wavelengthsNm) {
      nm *= 1000;
    }
  }
  // A reflectance's ends hold, as an index's do; its scale is stated, so that nothing is taken for percent.
  return spectraFromRows(std::move(rows), SpectralQuantity::Reflectance, StatedScale::Unity).front();
}

Spectrum readOpticalConstant(const std::filesystem::path& file, OpticalConstant part) {
  const std::string extension = lowerCase(utf8(file.extension()));
  const bool isYaml = extension == ".yml" || extension == ".yaml";
  return opticalConstantFrom(readTextFile(file), isYaml, utf8(file), part);
}

}  // namespace metamer::spectral
