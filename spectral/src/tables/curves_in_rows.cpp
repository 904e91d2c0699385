// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include "metamer/spectral/input_error.h"
#include "metamer/spectral/text.h"
#include "tables/layouts.h"
#include "tables/wavelength_cell.h"

namespace metamer::spectral {
namespace {

/// A row of fewer wavelengths is taken for numbers.
constexpr std::size_t kFewestWavelengths = 5;
constexpr double kShortestNm = 150;
constexpr double kLongestNm = 3000;
/// The row of wavelengths stands among the first lines.
constexpr std::size_t kMostLinesBefore = 200;

using Cells = std::vector<std::string_view>;

/// Cells first ... end - 1 of a row that are wavelengths in order.
struct Axis {
  std::size_t first = 0;
  std::size_t end = 0;
  double nmPerUnit = 1;
  bool unitStated = false;
  std::vector<double> nm;
};

/// The longest run of cells in order, within the range of wavelengths.
Axis axisIn(const Cells& cells, char separator) {
  Axis best;
  Axis run;
  const double rowUnit = cells.empty() ? 0 : nmPerUnitIn(cells.front());
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const std::optional<WavelengthCell> cell = wavelengthCell(cells[i], separator);
    const double unit = cell && cell->nmPerUnit > 0 ? cell->nmPerUnit : rowUnit;
    const double nm = cell ? cell->value * (unit > 0 ? unit : 1.0) : 0.0;
    const bool isOne = nm >= kShortestNm && nm <= kLongestNm;
    const bool isNext =
        isOne && (run.nm.empty() ||
                  (nm != run.nm.back() && (run.nm.size() == 1 || (nm > run.nm.back()) == (run.nm[1] > run.nm[0]))));
    if (!isNext) {
      run = {};
    }
    if (isOne) {
      run.first = run.nm.empty() ? i : run.first;
      run.end = i + 1;
      run.unitStated = unit > 0 || namesWavelength(cells.front());
      run.nm.push_back(nm);
      if (run.nm.size() > best.nm.size()) {
        best = run;
      }
    }
  }
  return best;
}

bool isAxis(const Axis& axis) {
  if (axis.nm.size() < kFewestWavelengths) {
    return false;
  }
  const auto [least, most] = std::minmax(axis.nm.front(), axis.nm.back());
  return least < kDomainEndNm && most > kDomainStartNm;
}

/// A number that can be a wavelength, in nm, micrometres or Angstrom; row numbers are none.
bool canBeWavelength(double value) {
  return (value >= kShortestNm && value <= 10 * kLongestNm) ||
         (value >= kShortestNm / 1000 && value <= kLongestNm / 1000 && value != std::round(value));
}

/// Whether rows from here on begin with wavelengths of their own: then curves stand in columns.
bool areRowsOfWavelengths(const TableText& text, std::size_t first) {
  std::vector<double> begins;
  for (std::size_t i = first; i < text.lines.size() && begins.size() < 3; ++i) {
    if (!text.lines[i].isComment) {
      const Cells cells = cellsOf(text.lines[i], text);
      const std::optional<WavelengthCell> cell = wavelengthCell(cells.front(), text.separator);
      if (!cell || !canBeWavelength(cell->value)) {
        return false;
      }
      begins.push_back(cell->value);
    }
  }
  return begins.size() == 3 && begins[0] != begins[1] && begins[1] != begins[2] &&
         (begins[1] > begins[0]) == (begins[2] > begins[1]);
}

/// The column that names the curves: by its heading, else the first before the wavelengths that holds words.
std::string nameOf(const Cells& header, const Cells& cells, const Axis& axis, std::size_t row) {
  for (std::size_t i = 0; i < std::min({axis.first, header.size(), cells.size()}); ++i) {
    const std::string heading = lowerCase(header[i]);
    const bool isName = heading.find("name") != std::string::npos || heading.find("title") != std::string::npos ||
                        heading.find("sample") != std::string::npos;
    if (isName && !unquoted(cells[i]).empty()) {
      return unquoted(cells[i]);
    }
  }
  for (std::size_t i = 0; i < std::min(axis.first, cells.size()); ++i) {
    if (!unquoted(cells[i]).empty() && !beginsLikeNumber(cells[i])) {
      return unquoted(cells[i]);
    }
  }
  return "row " + std::to_string(row);
}

class RowsReader {
 public:
  RowsReader(const TableText& text, Cells header, Axis axis)
      : m_text(text), m_header(std::move(header)), m_axis(std::move(axis)) {}

  /// A row with a number at the axis' first wavelengths is a curve; others are units, measures or a tail.
  void read(const TableLine& line) {
    const Cells cells = cellsOf(line, m_text);
    const std::size_t width = m_axis.nm.size();
    std::size_t numbers = 0;
    for (std::size_t i = m_axis.first; i < std::min(m_axis.end, cells.size()); ++i) {
      numbers += cellNumber(cells[i], m_text.separator) ? 1 : 0;
    }
    if (numbers * 2 < width) {
      return;
    }
    if (cells.size() < m_axis.end) {
      throw InputError(m_text.at(line), "columns", std::to_string(cells.size()),
                       "the row of wavelengths has " + std::to_string(m_header.size()) + "; give every row as many");
    }
    const std::size_t column = m_curves.rows.columns.size();
    std::vector<double>& values = m_curves.rows.columns.emplace_back();
    for (std::size_t i = 0; i < width; ++i) {
      const std::string_view cell = cells[m_axis.first + i];
      values.push_back(cellNumber(cell, m_text.separator).value_or(std::numeric_limits<double>::quiet_NaN()));
      if (std::isnan(values.back())) {
        m_curves.rows.flaws.emplace(std::pair(i, column), std::string(cell));
      }
    }
    m_curves.rows.names.push_back(nameOf(m_header, cells, m_axis, column + 1));
    m_curves.scale =
        std::any_of(cells.begin(), cells.begin() + static_cast<std::ptrdiff_t>(m_axis.first), statesPercent)
            ? StatedScale::Percent
            : m_curves.scale;
  }

  Curves finish() {
    SampledRows& rows = m_curves.rows;
    if (rows.columns.empty()) {
      return std::nullopt;
    }
    if (rows.columns.size() == 1 && rows.names.front() == "row 1") {
      rows.names.front() = stemOf(m_text.where);
    }
    m_curves.unitStated = m_axis.unitStated;
    rows.where = m_text.where;
    rows.wavelengthsNm = m_axis.nm;
    rows.rowWhere = [where = m_text.where, nm = rows.wavelengthsNm](std::size_t row) {
      return where + ": " + numberText(nm[row]) + " nm";
    };
    return std::vector<TableCurves>{std::move(m_curves)};
  }

 private:
  const TableText& m_text;
  Cells m_header;
  Axis m_axis;
  TableCurves m_curves;
};

}  // namespace

Curves readCurvesInRows(const TableText& text) {
  std::size_t lines = 0;
  for (std::size_t i = 0; i < text.lines.size() && lines < kMostLinesBefore; ++i) {
    if (text.lines[i].isComment) {
      continue;
    }
    ++lines;
    Cells header = cellsOf(text.lines[i], text);
    Axis axis = axisIn(header, text.separator);
    if (areRowsOfWavelengths(text, i)) {
      return std::nullopt;
    }
    if (!isAxis(axis) || areRowsOfWavelengths(text, i + 1)) {
      continue;
    }
    RowsReader reader(text, std::move(header), std::move(axis));
    for (std::size_t row = i + 1; row < text.lines.size(); ++row) {
      if (!text.lines[row].isComment) {
        reader.read(text.lines[row]);
      }
    }
    return reader.finish();
  }
  return std::nullopt;
}

}  // namespace metamer::spectral
