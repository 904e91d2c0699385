// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "files/sampled_rows.h"

namespace metamer::spectral {

/// A column of a table without what no use reads.
struct UsableCurve {
  std::vector<double> wavelengthsNm;  ///< rising
  std::vector<double> values;         ///< finite; not negative unless the quantity is Sensitivity
  std::vector<std::size_t> rows;      ///< of the table, one a value
  std::size_t firstUsed = 0;          ///< the values that 380 to 780 nm depends on
  std::size_t lastUsed = 0;
  std::vector<std::string> notes;  ///< what was cut, what the lamp lacks
};

/// @param rows  by rising wavelength
/// @throws InputError for what is used and cannot be: no number, below zero by more than noise, fewer than two samples
UsableCurve usableCurve(const SampledRows& rows, std::size_t column, SpectralQuantity quantity);

}  // namespace metamer::spectral
