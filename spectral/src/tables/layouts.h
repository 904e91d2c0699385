// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "files/sampled_rows.h"
#include "tables/table_text.h"

namespace metamer::spectral {

/// Curves that share their wavelengths, with what the file says of their scale.
struct TableCurves {
  SampledRows rows;
  StatedScale scale = StatedScale::NotStated;
  bool unitStated = false;  ///< the wavelengths' unit; nm otherwise
};

/// What a layout finds in a file: nothing where the file is not of that layout.
using Curves = std::optional<std::vector<TableCurves>>;

/// CGATS (ANSI CGATS.17, ISO 28178) as Argyll, i1Profiler and MeasureTool write it: SPEC_380 or nm380 among the fields,
/// one curve a set.
Curves readCgats(const TableText& text);

/// One curve a row under a row of wavelengths; columns before and behind them are the curve's name and its measures.
Curves readCurvesInRows(const TableText& text);

/// One wavelength a row, one curve a column, below any header rows, units and preamble, above any summary. A row may
/// carry its unit or a label ("380nm", "Spectral Data 380[nm]"). Files with several such blocks give several tables;
/// of labelled blocks that repeat each other the finest alone.
/// @throws InputError where there is none, or a row is broken
std::vector<TableCurves> readCurvesInColumns(const TableText& text);

/// The curves of a text table, by the first layout that knows it.
std::vector<TableCurves> readTable(const TableText& text);

}  // namespace metamer::spectral
