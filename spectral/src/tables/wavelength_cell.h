// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace metamer::spectral {

/// A wavelength as a cell states it.
struct WavelengthCell {
  double value = 0;
  double nmPerUnit = 0;     ///< 0 where the cell states no unit
  bool isLabelled = false;  ///< words stand before the number: "Spectral Data 380[nm]", "SPEC_380", "nm380"
};

/// A whole cell as a wavelength: a number, with its unit behind it or not ("380", "380nm", "0.38 um"), or with words
/// before it where the number can be nothing else (100 to 5000 nm). Nothing where it is something else.
/// @param separator  of the table's cells: a comma in a number is decimal where it is another
std::optional<WavelengthCell> wavelengthCell(std::string_view cell, char separator);

/// The unit of wavelengths that a heading names: nm for 1, micrometres 1000, Angstrom 0.1; 0 where it names none.
double nmPerUnitIn(std::string_view heading);

/// Whether a heading speaks of wavelengths, in one of the languages that meters speak.
bool namesWavelength(std::string_view heading);

/// Whether a heading states percent: "T (%)" does, "50% grey" is a name.
bool statesPercent(std::string_view heading);

/// Whether a cell of a heading is a unit and no name: "(nm)", "[W/m2/nm]", "a.u.", or empty.
bool isUnit(std::string_view heading);

}  // namespace metamer::spectral
