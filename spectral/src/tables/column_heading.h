// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "tables/table_text.h"

namespace metamer::spectral {

/// What the lines above a table say of its columns.
struct ColumnHeading {
  std::vector<std::string> names;  ///< one a column of values; empty where nothing names it
  double nmPerUnit = 0;            ///< 0 where no unit is stated
  std::vector<bool> percent;       ///< one a column of values
};

/// Reads the header rows right above a table: names, units, or both; else a comment there that has as many cells.
/// @param firstRow    the table's first line, of TableText::lines
/// @param columns     of the table, wavelengths included
/// @param isLabelled  each row says what it is: what stands above are other measures
/// @throws InputError where the only line above is a header for another number of columns
ColumnHeading columnHeading(const TableText& text, std::size_t firstRow, std::size_t columns, bool isLabelled);

}  // namespace metamer::spectral
