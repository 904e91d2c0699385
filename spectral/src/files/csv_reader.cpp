// SPDX-License-Identifier: Apache-2.0
#include "files/csv_reader.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>
#include <utility>

#include "metamer/spectral/input_error.h"
#include "metamer/spectral/spectral_files.h"
#include "metamer/spectral/text.h"

namespace metamer::spectral {
namespace {

constexpr std::size_t kMostRows = 1'000'000;
constexpr std::size_t kMostColumns = 10'000;
/// Columns may be separated by any white space.
constexpr char kWhiteSpaceDelimiter = ' ';

struct Line {
  std::size_t number;  ///< from 1
  std::string_view text;
};

std::string lineWhere(const std::string& where, std::size_t number) {
  return where + ":" + std::to_string(number);
}

/// Lines that hold something, in any of the three line endings.
std::vector<Line> contentLines(std::string_view text, const std::string& where) {
  std::vector<Line> lines;
  std::size_t number = 0;
  while (!text.empty()) {
    ++number;
    const std::size_t end = text.find_first_of("\r\n");
    const std::string_view line = trimmed(text.substr(0, end));
    const bool crLf = end != std::string_view::npos && text.substr(end, 2) == "\r\n";
    text = end == std::string_view::npos ? std::string_view{} : text.substr(end + (crLf ? 2 : 1));
    if (line.empty() || line.front() == '#') {
      continue;
    }
    // One more than the rows allowed: the header.
    if (lines.size() > kMostRows) {
      throw InputError(where, "rows", "", "more than one million; resample to a wider interval");
    }
    lines.push_back({number, line});
  }
  return lines;
}

bool isDigit(char c) {
  return c >= '0' && c <= '9';
}

/// Told by the first cell: a row whose first cell begins like a number is data even where the number is malformed, so
/// that a typing error in the first row is reported rather than taken for a heading.
bool looksLikeData(std::string_view line) {
  std::string_view cell = trimmed(line.substr(0, line.find_first_of(",;\t ")));
  if (!cell.empty() && cell.front() == '"') {
    cell = trimmed(cell.substr(1));
  }
  if (isNotFinite(cell)) {
    return true;
  }
  if (!cell.empty() && (cell.front() == '-' || cell.front() == '+')) {
    cell.remove_prefix(1);
  }
  if (!cell.empty() && cell.front() == '.') {
    cell.remove_prefix(1);
  }
  return !cell.empty() && isDigit(cell.front());
}

/// "380 0,5": the comma belongs to a number where white space separates the cells and touches no comma.
bool commasAreDecimal(std::string_view line) {
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == ',' && (i == 0 || i + 1 == line.size() || !isDigit(line[i - 1]) || !isDigit(line[i + 1]))) {
      return false;
    }
  }
  return line.find(' ') != std::string_view::npos;
}

char delimiterOf(std::string_view dataLine) {
  for (const char delimiter : {';', '\t'}) {
    if (dataLine.find(delimiter) != std::string_view::npos) {
      return delimiter;
    }
  }
  const bool hasComma = dataLine.find(',') != std::string_view::npos;
  return hasComma && !commasAreDecimal(dataLine) ? ',' : kWhiteSpaceDelimiter;
}

/// Cells of a row without the empty ones at its end, which spreadsheets write.
class Cells {
 public:
  Cells(std::string_view line, char delimiter) : m_rest(line), m_delimiter(delimiter) {
    if (delimiter != kWhiteSpaceDelimiter) {
      std::string blank = " \t";
      blank.push_back(delimiter);
      const std::size_t last = m_rest.find_last_not_of(blank);
      m_rest = last == std::string_view::npos ? std::string_view{} : m_rest.substr(0, last + 1);
    }
    m_atEnd = m_rest.empty();
  }

  std::optional<std::string_view> next() {
    if (m_atEnd) {
      return std::nullopt;
    }
    const bool quoted = m_rest.front() == '"';
    const std::size_t from = quoted ? endOfQuotes() : 0;
    const std::size_t end =
        m_delimiter == kWhiteSpaceDelimiter ? m_rest.find_first_of(" \t\f\v", from) : m_rest.find(m_delimiter, from);
    const std::string_view cell = trimmed(m_rest.substr(0, end));
    if (end == std::string_view::npos) {
      m_atEnd = true;
      return cell;
    }
    m_rest = m_delimiter == kWhiteSpaceDelimiter ? trimmed(m_rest.substr(end)) : trimmedFront(m_rest.substr(end + 1));
    return cell;
  }

 private:
  std::string_view trimmedFront(std::string_view text) const {
    while (!text.empty() && (text.front() == ' ' || text.front() == '\t') && text.front() != m_delimiter) {
      text.remove_prefix(1);
    }
    return text;
  }

  std::size_t endOfQuotes() const {
    std::size_t i = 1;
    while (i < m_rest.size()) {
      if (m_rest[i] == '"' && (i + 1 == m_rest.size() || m_rest[i + 1] != '"')) {
        return i + 1;
      }
      i += m_rest[i] == '"' ? 2 : 1;
    }
    return m_rest.size();
  }

  std::string_view m_rest;
  char m_delimiter;
  bool m_atEnd = false;
};

std::string unquoted(std::string_view cell) {
  if (cell.size() < 2 || cell.front() != '"' || cell.back() != '"') {
    return std::string(cell);
  }
  std::string text;
  cell = cell.substr(1, cell.size() - 2);
  for (std::size_t i = 0; i < cell.size(); ++i) {
    text += cell[i];
    if (cell[i] == '"' && i + 1 < cell.size() && cell[i + 1] == '"') {
      ++i;
    }
  }
  return std::string(trimmed(text));
}

/// True where one of the words of `cell` (runs of letters, any script) is `word`.
bool hasWord(const std::string& cell, std::string_view word) {
  const auto isLetter = [](char c) {
    return std::isalpha(static_cast<unsigned char>(c)) != 0 || static_cast<unsigned char>(c) >= 0x80U;
  };
  for (std::size_t at = cell.find(word); at != std::string::npos; at = cell.find(word, at + 1)) {
    const std::size_t end = at + word.size();
    if ((at == 0 || !isLetter(cell[at - 1])) && (end == cell.size() || !isLetter(cell[end]))) {
      return true;
    }
  }
  return false;
}

double nmPerUnit(const std::string& wavelengthHeading) {
  const std::string heading = lowerCase(wavelengthHeading);
  const auto names = [&](const auto& words) {
    return std::any_of(words.begin(), words.end(), [&](std::string_view word) { return hasWord(heading, word); });
  };
  // The two code points of the micro sign, and both letter cases of the ring A with the Angstrom sign.
  constexpr std::array<std::string_view, 9> kMicrometre{
      "um", "\u00b5m", "\u03bcm", "micrometre", "micrometer", "micrometres", "micrometers", "micron", "microns"};
  constexpr std::array<std::string_view, 5> kAngstrom{"angstrom", "angstroms", "\u00c5", "\u00e5", "\u212b"};
  return names(kMicrometre) ? 1000.0 : names(kAngstrom) ? 0.1 : 1.0;
}

/// "T (%)" and "percent" state a unit, "50% grey" is a name.
bool statesPercent(const std::string& heading) {
  const std::string lower = lowerCase(heading);
  for (const std::string_view mark : {std::string_view("%"), std::string_view("percent")}) {
    const std::size_t at = lower.find(mark);
    if (at == std::string::npos) {
      continue;
    }
    const std::string_view before = trimmed(std::string_view(lower).substr(0, at));
    if (before.empty() || !isDigit(before.back())) {
      return true;
    }
  }
  return false;
}

struct Header {
  std::vector<std::string> cells;  ///< empty where the file has none
  double nmPerUnit = 1;
  bool percent = false;
};

Header readHeader(std::string_view line, char delimiter) {
  Header header;
  Cells cells(line, delimiter);
  while (const std::optional<std::string_view> cell = cells.next()) {
    header.cells.push_back(unquoted(*cell));
    if (header.cells.size() > kMostColumns) {
      break;
    }
  }
  if (!header.cells.empty()) {
    header.nmPerUnit = nmPerUnit(header.cells.front());
    header.percent = std::any_of(header.cells.begin() + 1, header.cells.end(), statesPercent);
  }
  return header;
}

/// A cell as a number, a decimal comma read as a point where the delimiter is not a comma.
double cellNumber(std::string_view cell, char delimiter, const std::string& where, const std::string& field) {
  if (delimiter != ',' && cell.find(',') != std::string_view::npos) {
    std::string pointed(cell);
    std::replace(pointed.begin(), pointed.end(), ',', '.');
    // More than one separator is no number: say so about the cell as written.
    return parseNumber(pointed) ? *parseNumber(pointed) : requiredNumber(cell, where, field);
  }
  if (cell.size() >= 2 && cell.front() == '"') {
    return requiredNumber(unquoted(cell), where, field);
  }
  return requiredNumber(cell, where, field);
}

class TableReader {
 public:
  TableReader(const std::string& where, char delimiter) : m_where(where), m_delimiter(delimiter) {}

  void readRow(const Line& line) {
    const std::string where = lineWhere(m_where, line.number);
    Cells cells(line.text, m_delimiter);
    m_row.clear();
    while (const std::optional<std::string_view> cell = cells.next()) {
      if (m_row.size() > kMostColumns) {
        throw InputError(where, "columns", "", "more than " + std::to_string(kMostColumns) + "; split the file");
      }
      m_row.push_back(cellNumber(*cell, m_delimiter, where, m_row.empty() ? "wavelength" : "value"));
    }
    if (m_row.size() < 2) {
      throw InputError(where, "columns", std::string(line.text),
                       "only one; a wavelength and one or more values a row are needed");
    }
    if (m_columns.empty()) {
      m_columns.resize(m_row.size() - 1);
    }
    if (m_row.size() != m_columns.size() + 1) {
      throw InputError(where, "columns", std::to_string(m_row.size()),
                       "the first row has " + std::to_string(m_columns.size() + 1) +
                           "; give every row as many, and separate columns by ';' where commas are decimal");
    }
    m_wavelengths.push_back(m_row.front());
    m_lineNumbers.push_back(line.number);
    for (std::size_t c = 0; c < m_columns.size(); ++c) {
      m_columns[c].push_back(m_row[c + 1]);
    }
  }

  SampledRows finish(const Header& header) {
    if (!header.cells.empty() && header.cells.size() != m_columns.size() + 1) {
      throw InputError(m_where, "columns", std::to_string(m_columns.size() + 1),
                       "the header has " + std::to_string(header.cells.size()) +
                           "; give both as many, and separate columns by ';' where commas are decimal");
    }
    for (double& wavelength : m_wavelengths) {
      wavelength *= header.nmPerUnit;
    }
    SampledRows rows;
    rows.where = m_where;
    rows.wavelengthsNm = std::move(m_wavelengths);
    rows.columns = std::move(m_columns);
    for (std::size_t c = 0; c < rows.columns.size(); ++c) {
      std::string name = header.cells.empty() ? "" : header.cells[c + 1];
      if (name.empty()) {
        name = rows.columns.size() == 1 ? stemOf(m_where) : "column " + std::to_string(c + 2);
      }
      rows.names.push_back(std::move(name));
    }
    rows.rowWhere = [where = m_where, numbers = std::move(m_lineNumbers)](std::size_t row) {
      return lineWhere(where, numbers[row]);
    };
    return rows;
  }

 private:
  const std::string& m_where;
  char m_delimiter;
  std::vector<double> m_row;
  std::vector<double> m_wavelengths;
  std::vector<std::vector<double>> m_columns;
  std::vector<std::size_t> m_lineNumbers;
};

}  // namespace

std::vector<Spectrum> readCsvOfScale(std::string_view text, const std::string& where, SpectralQuantity quantity,
                                     StatedScale scale) {
  const std::vector<Line> lines = contentLines(checkedUtf8(text, where), where);
  const std::size_t first = !lines.empty() && !looksLikeData(lines.front().text) ? 1 : 0;
  if (lines.size() == first) {
    return spectraFromRows({where, {}, {}, {}, {}}, quantity, scale);
  }
  if (lines.size() - first > kMostRows) {
    throw InputError(where, "rows", "", "more than one million; resample to a wider interval");
  }
  const char delimiter = delimiterOf(lines[first].text);
  const Header header = first == 1 ? readHeader(lines.front().text, delimiter) : Header{};
  TableReader reader(where, delimiter);
  for (std::size_t i = first; i < lines.size(); ++i) {
    reader.readRow(lines[i]);
  }
  if (scale == StatedScale::NotStated && header.percent) {
    scale = StatedScale::Percent;
  }
  return spectraFromRows(reader.finish(header), quantity, scale);
}

std::vector<Spectrum> readCsv(const std::string& text, const std::string& where, SpectralQuantity quantity) {
  return readCsvOfScale(text, where, quantity, StatedScale::NotStated);
}

}  // namespace metamer::spectral
