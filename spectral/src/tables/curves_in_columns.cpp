// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include "metamer/spectral/input_error.h"
#include "metamer/spectral/text.h"
#include "tables/column_heading.h"
#include "tables/layouts.h"
#include "tables/wavelength_cell.h"

namespace metamer::spectral {
namespace {

constexpr std::size_t kNone = std::string::npos;

/// A line as the layout sees it.
struct Row {
  std::size_t line = 0;  ///< of TableText::lines
  WavelengthCell wavelength;
};

/// Adjacent rows of one table.
struct Block {
  std::vector<Row> rows;
};

/// The first cell of a line, without a look at the others.
std::string_view firstCell(const TableLine& line, char separator) {
  const std::string_view text = separator == kWhiteSpaceSeparator ? trimmed(line.text) : std::string_view(line.text);
  if (!text.empty() && text.front() == '"') {
    const std::size_t close = text.find('"', 1);
    return text.substr(0, close == std::string_view::npos ? close : close + 1);
  }
  return trimmed(
      text.substr(0, separator == kWhiteSpaceSeparator ? text.find_first_of(" \t\f\v") : text.find(separator)));
}

/// Whether a line that begins with no wavelength is a row all the same, with a fault: its first cell begins like a
/// number or is empty, and numbers follow.
bool isBrokenRow(const TableLine& line, const TableText& text) {
  const std::vector<std::string_view> cells = cellsOf(line, text);
  const bool begins = beginsLikeNumber(cells.front()) || cells.front().empty();
  return begins && cells.size() > 1 &&
         std::all_of(cells.begin() + 1, cells.end(),
                     [&](std::string_view cell) {
                       return cell.empty() || cellNumber(cell, text.separator) || isNotFinite(cell);
                     }) &&
         std::any_of(cells.begin() + 1, cells.end(), [](std::string_view cell) { return !cell.empty(); });
}

[[noreturn]] void throwBrokenRow(const TableLine& line, const TableText& text) {
  requiredNumber(firstCell(line, text.separator), text.at(line), "wavelength");
  throw InputError(text.at(line), "wavelength", std::string(line.text), "must be a number such as 550");
}

/// Runs of lines that begin with a wavelength. A labelled one that goes back begins another run.
std::vector<Block> blocksOf(const TableText& text) {
  std::vector<Block> blocks;
  std::size_t broken = kNone;
  bool inBlock = false;
  for (std::size_t i = 0; i < text.lines.size(); ++i) {
    const TableLine& line = text.lines[i];
    if (line.isComment) {
      continue;
    }
    const std::optional<WavelengthCell> cell = wavelengthCell(firstCell(line, text.separator), text.separator);
    if (!cell) {
      inBlock = false;
      broken = isBrokenRow(line, text) ? i : kNone;
      // Right behind rows it is one of them; before rows it is found when they begin.
      if (broken != kNone && i > 0 && !blocks.empty() && blocks.back().rows.back().line + 1 == i) {
        throwBrokenRow(line, text);
      }
      continue;
    }
    if (broken != kNone) {
      throwBrokenRow(text.lines[broken], text);
    }
    const bool goesBack = inBlock && (cell->isLabelled || cell->nmPerUnit > 0) && blocks.back().rows.size() > 1 &&
                          (cell->value > blocks.back().rows.back().wavelength.value) !=
                              (blocks.back().rows[1].wavelength.value > blocks.back().rows[0].wavelength.value);
    if (!inBlock || goesBack) {
      blocks.emplace_back();
      inBlock = true;
    }
    blocks.back().rows.push_back({i, *cell});
  }
  return blocks;
}

/// Cells up to the last one that holds something.
std::size_t filled(const std::vector<std::string_view>& cells) {
  std::size_t count = cells.size();
  while (count > 0 && cells[count - 1].empty()) {
    --count;
  }
  return count;
}

class ColumnsReader {
 public:
  ColumnsReader(const TableText& text, const Block& block) : m_text(text), m_block(block) {}

  /// Columns of one scale after the other; none where all are remarks.
  std::vector<TableCurves> read() {
    countColumns();
    const ColumnHeading heading =
        columnHeading(m_text, m_block.rows.front().line, m_columns, m_block.rows.front().wavelength.isLabelled);
    m_curves.rows.columns.resize(m_columns - 1);
    for (std::vector<double>& column : m_curves.rows.columns) {
      column.reserve(m_block.rows.size());
    }
    for (const Row& row : m_block.rows) {
      readRow(row, heading);
    }
    m_curves.rows.where = m_text.where;
    m_curves.rows.rowWhere = [where = m_text.where, numbers = std::move(m_lineNumbers)](std::size_t row) {
      return where + ":" + std::to_string(numbers[row]);
    };
    giveNames(heading);
    return byScale(keptColumns(), heading);
  }

 private:
  /// The first row tells, but for cells at its end that are empty there alone.
  void countColumns() {
    const auto cellsOfRow = [&](const Row& row) { return cellsOf(m_text.lines[row.line], m_text); };
    const std::vector<std::string_view> first = cellsOfRow(m_block.rows.front());
    m_columns = filled(first);
    for (const Row& row : m_block.rows) {
      if (m_columns == first.size()) {
        break;
      }
      m_columns = std::max(m_columns, std::min(first.size(), filled(cellsOfRow(row))));
    }
    if (m_columns < 2) {
      throwOnlyOne(m_text.lines[m_block.rows.front().line]);
    }
  }

  [[noreturn]] void throwOnlyOne(const TableLine& line) const {
    throw InputError(m_text.at(line), "columns", shortened(std::string(trimmed(line.text)), 60),
                     "only one; a wavelength and one or more values a row are needed");
  }

  void readRow(const Row& row, const ColumnHeading& heading) {
    const TableLine& line = m_text.lines[row.line];
    const std::vector<std::string_view> cells = cellsOf(line, m_text);
    const double unit = row.wavelength.nmPerUnit > 0 ? row.wavelength.nmPerUnit : heading.nmPerUnit;
    const double nm = row.wavelength.value * (unit > 0 ? unit : 1.0);
    m_curves.unitStated = m_curves.unitStated || unit > 0;
    const std::size_t count = filled(cells);
    if (count < 2 && m_columns == 2) {
      if (nm < kDomainStartNm || nm > kDomainEndNm) {
        return;
      }
      throwOnlyOne(line);
    }
    if (count > m_columns || cells.size() < m_columns) {
      throw InputError(m_text.at(line), "columns", std::to_string(std::max(count, std::min(cells.size(), m_columns))),
                       "the first row has " + std::to_string(m_columns) +
                           "; give every row as many, and separate columns by ';' where commas are decimal");
    }
    const std::size_t rowIndex = m_curves.rows.wavelengthsNm.size();
    m_curves.rows.wavelengthsNm.push_back(nm);
    m_lineNumbers.push_back(line.number);
    for (std::size_t c = 0; c + 1 < m_columns; ++c) {
      const std::string_view cell = cells[c + 1];
      const std::optional<double> number = cellNumber(cell, m_text.separator);
      m_curves.rows.columns[c].push_back(number.value_or(std::numeric_limits<double>::quiet_NaN()));
      if (!number) {
        m_curves.rows.flaws.emplace(std::pair(rowIndex, c), std::string(cell));
      }
    }
  }

  /// Those with a number: others hold remarks.
  std::vector<std::size_t> keptColumns() const {
    const std::vector<std::vector<double>>& columns = m_curves.rows.columns;
    std::vector<std::size_t> kept;
    for (std::size_t c = 0; c < columns.size(); ++c) {
      const auto isThere = [](double value) { return !std::isnan(value); };
      if (columns.size() == 1 || std::any_of(columns[c].begin(), columns[c].end(), isThere)) {
        kept.push_back(c);
      }
    }
    return kept;
  }

  void giveNames(const ColumnHeading& heading) {
    const std::size_t kept = keptColumns().size();
    for (std::size_t c = 0; c + 1 < m_columns; ++c) {
      std::string name = c < heading.names.size() ? heading.names[c] : "";
      if (name.empty()) {
        name = kept == 1 ? stemOf(m_text.where) : "column " + std::to_string(c + 2);
      }
      m_curves.rows.names.push_back(std::move(name));
    }
  }

  std::vector<TableCurves> byScale(const std::vector<std::size_t>& kept, const ColumnHeading& heading) {
    std::vector<TableCurves> all;
    for (std::size_t begin = 0; begin < kept.size();) {
      const bool percent = heading.percent[kept[begin]];
      std::size_t end = begin;
      while (end < kept.size() && heading.percent[kept[end]] == percent) {
        ++end;
      }
      const std::vector<std::size_t> run(kept.begin() + static_cast<std::ptrdiff_t>(begin),
                                         kept.begin() + static_cast<std::ptrdiff_t>(end));
      TableCurves curves = begin == 0 && end == kept.size() ? std::move(m_curves) : m_curves;
      curves.rows = columnsOf(std::move(curves.rows), run);
      curves.scale = percent ? StatedScale::Percent : StatedScale::NotStated;
      all.push_back(std::move(curves));
      begin = end;
    }
    return all;
  }

  const TableText& m_text;
  const Block& m_block;
  std::size_t m_columns = 0;
  TableCurves m_curves;
  std::vector<std::size_t> m_lineNumbers;
};

/// Whether rows can be wavelengths of visible light, in one of the units: numbered figures are none.
bool isVisible(const Block& block) {
  const auto [least, most] = std::minmax(block.rows.front().wavelength.value, block.rows.back().wavelength.value);
  for (const double unit : {1.0, 1000.0, 0.1}) {
    if (block.rows.size() > 1 && least * unit < kDomainEndNm && most * unit > kDomainStartNm) {
      return true;
    }
  }
  return false;
}

/// Without what stands before and after a table: settings and figures that begin with a number.
void keepTables(std::vector<Block>& blocks) {
  std::size_t most = 0;
  for (const Block& block : blocks) {
    most = std::max(most, block.rows.size());
  }
  const bool isOneVisible = std::any_of(blocks.begin(), blocks.end(), isVisible);
  std::erase_if(blocks, [&](const Block& block) {
    return (block.rows.size() < 2 && block.rows.size() * 2 < most) || (isOneVisible && !isVisible(block));
  });
}

/// Of labelled blocks one after the other, over the same range: the finest, where one is finer.
void keepFinest(std::vector<Block>& blocks) {
  for (std::size_t i = 0; i + 1 < blocks.size();) {
    const Block& a = blocks[i];
    const Block& b = blocks[i + 1];
    const auto isLabelled = [](const Block& block) {
      const WavelengthCell& cell = block.rows.front().wavelength;
      return cell.isLabelled || cell.nmPerUnit > 0;
    };
    const bool repeat = isLabelled(a) && isLabelled(b) &&
                        a.rows.front().wavelength.value == b.rows.front().wavelength.value &&
                        a.rows.size() != b.rows.size();
    if (!repeat) {
      ++i;
      continue;
    }
    const std::size_t coarser = a.rows.size() < b.rows.size() ? i : i + 1;
    blocks.erase(blocks.begin() + static_cast<std::ptrdiff_t>(coarser));
  }
}

}  // namespace

std::vector<TableCurves> readCurvesInColumns(const TableText& text) {
  std::vector<Block> blocks = blocksOf(text);
  keepTables(blocks);
  keepFinest(blocks);
  std::vector<TableCurves> all;
  for (const Block& block : blocks) {
    if (block.rows.size() > kMostTableRows) {
      throw InputError(text.where, "rows", "", "more than one million; resample to a wider interval");
    }
    for (TableCurves& curves : ColumnsReader(text, block).read()) {
      all.push_back(std::move(curves));
    }
  }
  if (all.empty()) {
    throw InputError(text.where, "rows", "", "no rows of numbers; a wavelength and a value a row are needed");
  }
  return all;
}

std::vector<TableCurves> readTable(const TableText& text) {
  for (const auto layout : {readCgats, readCurvesInRows}) {
    if (Curves curves = layout(text)) {
      return *std::move(curves);
    }
  }
  return readCurvesInColumns(text);
}

}  // namespace metamer::spectral
