// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
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
};

/// Reads a whole token as a finite number.
/// @throws InputError for anything else, with a remedy for decimal commas, NaN and empty cells
double requiredNumber(std::string_view token, const std::string& where, const std::string& field);

/// Rows in falling order are turned round; percent becomes 0 ... 1.
/// @throws InputError: no rows, a duplicate wavelength, an order that changes, no row within the visible domain,
///   a negative value where the quantity allows none, an unclear scale
std::vector<Spectrum> spectraFromRows(SampledRows rows, SpectralQuantity quantity, StatedScale scale);

/// Name of spectra in a file that names none: the file's, without folder and extension.
std::string stemOf(const std::string& where);

/// "spectral power distribution", ... as the manifest and messages write it.
std::string quantityName(SpectralQuantity quantity);

}  // namespace metamer::spectral
