// SPDX-License-Identifier: Apache-2.0
#include "tables/column_heading.h"

#include <algorithm>
#include <functional>
#include <set>

#include "metamer/spectral/input_error.h"
#include "metamer/spectral/text.h"
#include "tables/wavelength_cell.h"

namespace metamer::spectral {
namespace {

/// Names, quantities, units: no meter writes more rows.
constexpr std::size_t kMostHeaderRows = 4;

std::vector<std::string> headerCells(const TableLine& line, const TableText& text) {
  std::vector<std::string> cells;
  for (const std::string_view cell : cellsOf(line, text)) {
    cells.push_back(unquoted(cell));
  }
  return cells;
}

/// A row as wide as the table, but for empty cells at its end.
bool isAsWide(const std::vector<std::string>& cells, std::size_t columns) {
  return cells.size() >= columns && std::all_of(cells.begin() + static_cast<std::ptrdiff_t>(columns), cells.end(),
                                                [](const std::string& cell) { return cell.empty(); });
}

std::size_t filled(const std::vector<std::string>& cells) {
  std::size_t count = cells.size();
  while (count > 0 && cells[count - 1].empty()) {
    --count;
  }
  return count;
}

/// Whether a row's cells over the values name columns apart.
bool namesApart(const std::vector<std::string>& cells, std::size_t columns) {
  std::set<std::string> names;
  for (std::size_t c = 1; c < columns; ++c) {
    if (!isUnit(cells[c])) {
      names.insert(cells[c]);
    }
  }
  return !names.empty() && (columns == 2 || names.size() > 1);
}

/// Whether each cell over the values states percent, itself or, where it is empty, as the one before it does: a heading
/// over several columns stands over the first.
std::vector<bool> percentOver(const std::vector<std::string>& cells, std::size_t columns) {
  std::vector<bool> percent;
  for (std::size_t c = 1; c < columns; ++c) {
    percent.push_back(cells[c].empty() ? !percent.empty() && percent.back() : statesPercent(cells[c]));
  }
  return percent;
}

class HeadingReader {
 public:
  HeadingReader(const TableText& text, std::size_t columns) : m_text(text), m_columns(columns) {
    m_heading.percent.assign(columns - 1, false);
  }

  /// Whether the row belongs to the heading. Rows come from the table upwards.
  bool take(const std::vector<std::string>& cells) {
    const bool areMeasures =
        !namesWavelength(cells.front()) && std::all_of(cells.begin() + 1, cells.end(), [&](const std::string& cell) {
          return cell.empty() || cellNumber(cell, m_text.separator);
        });
    if (!isAsWide(cells, m_columns) || (areMeasures && filled(cells) > 1)) {
      return false;
    }
    m_heading.nmPerUnit = m_heading.nmPerUnit > 0 ? m_heading.nmPerUnit : nmPerUnitIn(cells.front());
    const std::vector<bool> percent = percentOver(cells, m_columns);
    std::transform(percent.begin(), percent.end(), m_heading.percent.begin(), m_heading.percent.begin(),
                   std::logical_or<>());
    const bool areUnits = std::all_of(cells.begin(), cells.end(), isUnit);
    if (!areUnits && (m_heading.names.empty() || (!m_apart && namesApart(cells, m_columns)))) {
      m_heading.names.assign(cells.begin() + 1, cells.begin() + static_cast<std::ptrdiff_t>(m_columns));
      m_apart = namesApart(cells, m_columns);
    }
    return true;
  }

  /// Nothing above can say more.
  bool isComplete() const { return m_apart; }
  ColumnHeading& heading() { return m_heading; }

 private:
  const TableText& m_text;
  std::size_t m_columns;
  ColumnHeading m_heading;
  bool m_apart = false;
};

/// Whether a line stands for columns of another number: then the table may not be what it seems.
bool isOtherHeader(const std::vector<std::string>& cells, bool isOnlyLine, const TableText& text) {
  return text.separator != kWhiteSpaceSeparator && filled(cells) > 1 && (isOnlyLine || namesWavelength(cells.front()));
}

}  // namespace

ColumnHeading columnHeading(const TableText& text, std::size_t firstRow, std::size_t columns, bool isLabelled) {
  HeadingReader reader(text, columns);
  if (isLabelled) {
    return reader.heading();
  }
  std::size_t rows = 0;
  for (std::size_t i = firstRow; i-- > 0 && rows < kMostHeaderRows && !reader.isComplete();) {
    const TableLine& line = text.lines[i];
    if (line.isComment) {
      continue;
    }
    const std::vector<std::string> cells = headerCells(line, text);
    if (wavelengthCell(cells.front(), text.separator)) {
      break;
    }
    if (!reader.take(cells)) {
      if (rows == 0 && isOtherHeader(cells, i == 0, text)) {
        throw InputError(text.where, "columns", std::to_string(columns),
                         "the header has " + std::to_string(filled(cells)) +
                             "; give both as many, and separate columns by ';' where commas are decimal");
      }
      // A header whose words are apart as its columns are: its units count, its names cannot be told.
      if (rows == 0 && text.separator == kWhiteSpaceSeparator && namesWavelength(line.text)) {
        reader.heading().nmPerUnit = nmPerUnitIn(line.text);
        reader.heading().percent.assign(columns - 1, statesPercent(line.text));
      }
      break;
    }
    ++rows;
  }
  // "# wavelength (um)  n"
  for (std::size_t i = firstRow; i-- > 0 && rows == 0 && text.lines[i].isComment;) {
    const TableLine& line = text.lines[i];
    std::vector<std::string> cells = headerCells(line, text);
    if (cells.size() == columns && !beginsLikeNumber(line.text) && reader.take(cells)) {
      break;
    }
    if (namesWavelength(line.text) && nmPerUnitIn(line.text) > 0) {
      reader.heading().nmPerUnit = nmPerUnitIn(line.text);
      break;
    }
  }
  return reader.heading();
}

}  // namespace metamer::spectral
