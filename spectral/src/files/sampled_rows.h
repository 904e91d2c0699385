// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "metamer/spectral/spectrum.h"

namespace metamer::spectral {

/// What a file says of the scale of reflectances and transmittances.
enum class StatedScale {
  NotStated,  ///< told by the values: above 2 is percent
  Percent,
  Unity,  ///< certain to be 0 ... 1: no guess
};

/// A table as a reader found it, before it is known to make spectra. The same checks serve every format.
struct SampledRows {
  std::string where;                                     ///< what messages call the file
  std::vector<std::string> names;                        ///< one a column
  std::vector<double> wavelengthsNm;                     ///< one a row
  std::vector<std::vector<double>> columns;              ///< columns[c][row]
  std::function<std::string(std::size_t row)> rowWhere;  ///< what messages call a row, "gel.csv:12"
  /// What stands where columns[c][row] is NaN, by row and column: text that is no number, or nothing.
  std::map<std::pair<std::size_t, std::size_t>, std::string> flaws = {};
};

/// Some columns of a table, in the order given.
SampledRows columnsOf(SampledRows rows, const std::vector<std::size_t>& kept);

/// Reads a whole token as a finite number.
/// @throws InputError for anything else, with a remedy for decimal commas, NaN and empty cells
double requiredNumber(std::string_view token, const std::string& where, const std::string& field);

/// Rows in falling order are turned round; percent becomes 0 ... 1. Samples that no use reads, beyond the last one at
/// or outside either end of the visible domain, are not judged: they go where they are no numbers, and become 0 where
/// they are negative. Within, noise below zero (to 5 % of the peak) becomes 0 with a note; an empty cell at an end of a
/// sensitivity ends it; a light many of whose values are exactly 0 gets a note.
/// @throws InputError: no rows, a duplicate wavelength, an order that changes, no row within the visible domain,
///   a value that is no number, a negative value where the quantity allows none, an unclear scale
std::vector<Spectrum> spectraFromRows(SampledRows rows, SpectralQuantity quantity, StatedScale scale);

/// Name of spectra in a file that names none: the file's, without folder and extension.
std::string stemOf(const std::string& where);

/// "spectral power distribution", ... as the manifest and messages write it.
std::string quantityName(SpectralQuantity quantity);

}  // namespace metamer::spectral
