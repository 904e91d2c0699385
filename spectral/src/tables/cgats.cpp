// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "metamer/spectral/input_error.h"
#include "metamer/spectral/text.h"
#include "tables/layouts.h"
#include "tables/wavelength_cell.h"

namespace metamer::spectral {
namespace {

struct Token {
  std::string text;
  std::size_t lineNumber;
};

/// Words of a line, quoted ones whole, up to a comment.
void addTokens(const TableLine& line, std::vector<Token>& tokens) {
  std::string_view rest = trimmed(line.text);
  while (!rest.empty() && rest.front() != '#') {
    const bool isQuoted = rest.front() == '"';
    const std::size_t close = isQuoted ? rest.find('"', 1) : rest.find_first_of(" \t");
    const std::size_t end = close == std::string_view::npos ? rest.size() : close + (isQuoted ? 1 : 0);
    tokens.push_back({unquoted(rest.substr(0, end)), line.number});
    rest = trimmed(rest.substr(end));
  }
}

/// Evenly spaced bands, as Argyll's header states them; 0 where it does not.
struct StatedBands {
  double count = 0;
  double startNm = 0;
  double endNm = 0;
};

/// One table of the file: its fields and the words of its sets.
struct CgatsTable {
  std::vector<Token> fields;
  std::vector<Token> data;
  StatedScale scale = StatedScale::NotStated;
  StatedBands bands;
};

/// What follows a keyword as a number; nothing where the line begins with another word.
std::optional<double> valueOf(std::string_view keyword, std::string_view line) {
  const bool isIt = line.size() > keyword.size() && line.substr(0, keyword.size()) == keyword;
  return isIt ? parseNumber(unquoted(trimmed(line.substr(keyword.size())))) : std::nullopt;
}

void readKeyword(std::string_view line, CgatsTable& table) {
  if (const auto norm = valueOf("SPECTRAL_NORM", line)) {
    table.scale = *norm == 100 ? StatedScale::Percent : *norm == 1 ? StatedScale::Unity : StatedScale::NotStated;
  }
  table.bands.count = valueOf("SPECTRAL_BANDS", line).value_or(table.bands.count);
  table.bands.startNm = valueOf("SPECTRAL_START_NM", line).value_or(table.bands.startNm);
  table.bands.endNm = valueOf("SPECTRAL_END_NM", line).value_or(table.bands.endNm);
}

std::vector<CgatsTable> tablesOf(const TableText& text) {
  std::vector<CgatsTable> tables(1);
  std::vector<Token>* reading = nullptr;
  for (const TableLine& line : text.lines) {
    if (line.isComment) {
      continue;
    }
    const std::string_view word = trimmed(line.text);
    if (word == "BEGIN_DATA_FORMAT") {
      reading = &tables.back().fields;
      reading->clear();
    } else if (word == "BEGIN_DATA") {
      reading = &tables.back().data;
    } else if (word == "END_DATA_FORMAT") {
      reading = nullptr;
    } else if (word == "END_DATA") {
      reading = nullptr;
      // The fields of a table, and their bands, hold for those behind it, until others are given.
      tables.push_back({tables.back().fields, {}, StatedScale::NotStated, tables.back().bands});
    } else if (reading != nullptr) {
      addTokens(line, *reading);
    } else {
      readKeyword(word, tables.back());
    }
  }
  return tables;
}

/// "SAMPLE_NAME" before "SAMPLE_ID" and their siblings.
std::optional<std::size_t> nameField(const std::vector<Token>& fields) {
  for (const std::string_view wanted : {"sample_name", "samplename", "sample_id", "sampleid"}) {
    const auto at =
        std::find_if(fields.begin(), fields.end(), [&](const Token& field) { return lowerCase(field.text) == wanted; });
    if (at != fields.end()) {
      return static_cast<std::size_t>(at - fields.begin());
    }
  }
  return std::nullopt;
}

/// Fields are named in whole nanometres: bands 3.33 nm apart, as an i1Pro measures at high resolution, are where the
/// header says, if that rounds to the names.
void placeBands(const StatedBands& stated, std::vector<double>& wavelengthsNm) {
  const auto count = static_cast<double>(wavelengthsNm.size());
  if (stated.count != count || count < 2) {
    return;
  }
  std::vector<double> even;
  for (double band = 0; band < count; ++band) {
    even.push_back(stated.startNm + band * (stated.endNm - stated.startNm) / (count - 1));
  }
  constexpr double kRounding = 0.5 + 1e-6;
  if (std::equal(even.begin(), even.end(), wavelengthsNm.begin(),
                 [](double exact, double name) { return std::abs(exact - name) <= kRounding; })) {
    wavelengthsNm = std::move(even);
  }
}

std::optional<TableCurves> curvesOf(const CgatsTable& table, const TableText& text) {
  std::vector<std::size_t> bands;
  TableCurves curves;
  for (std::size_t f = 0; f < table.fields.size(); ++f) {
    const std::optional<WavelengthCell> cell = wavelengthCell(table.fields[f].text, kWhiteSpaceSeparator);
    if (cell && cell->isLabelled) {
      bands.push_back(f);
      curves.rows.wavelengthsNm.push_back(cell->value);
    }
  }
  if (bands.empty() || table.data.empty()) {
    return std::nullopt;
  }
  placeBands(table.bands, curves.rows.wavelengthsNm);
  const std::size_t width = table.fields.size();
  if (table.data.size() % width != 0) {
    throw InputError(text.where + ":" + std::to_string(table.data.back().lineNumber), "BEGIN_DATA",
                     std::to_string(table.data.size()) + " values",
                     "are no whole sets of " + std::to_string(width) + " fields; the file is cut short or broken");
  }
  const std::optional<std::size_t> name = nameField(table.fields);
  const std::size_t sets = table.data.size() / width;
  curves.scale = table.scale;
  curves.unitStated = true;
  curves.rows.where = text.where;
  for (std::size_t s = 0; s < sets; ++s) {
    const Token* set = &table.data[s * width];
    std::string called = name ? set[*name].text : "";
    if (called.empty()) {
      called = sets == 1 ? stemOf(text.where) : "set " + std::to_string(s + 1);
    }
    curves.rows.names.push_back(std::move(called));
    std::vector<double>& values = curves.rows.columns.emplace_back();
    for (std::size_t b = 0; b < bands.size(); ++b) {
      const Token& token = set[bands[b]];
      values.push_back(cellNumber(token.text, kWhiteSpaceSeparator).value_or(std::numeric_limits<double>::quiet_NaN()));
      if (std::isnan(values.back())) {
        curves.rows.flaws.emplace(std::pair(b, s), token.text);
      }
    }
  }
  curves.rows.rowWhere = [where = text.where, nm = curves.rows.wavelengthsNm](std::size_t row) {
    return where + ": " + numberText(nm[row]) + " nm";
  };
  return curves;
}

}  // namespace

Curves readCgats(const TableText& text) {
  const bool isCgats = std::any_of(text.lines.begin(), text.lines.end(),
                                   [](const TableLine& line) { return trimmed(line.text) == "BEGIN_DATA_FORMAT"; });
  if (!isCgats) {
    return std::nullopt;
  }
  std::vector<TableCurves> all;
  for (const CgatsTable& table : tablesOf(text)) {
    if (std::optional<TableCurves> curves = curvesOf(table, text)) {
      all.push_back(*std::move(curves));
    }
  }
  if (all.empty()) {
    throw InputError(text.where, "BEGIN_DATA_FORMAT", "",
                     "has no spectral fields such as SPEC_380, or no sets; export the file with its spectra");
  }
  return all;
}

}  // namespace metamer::spectral
