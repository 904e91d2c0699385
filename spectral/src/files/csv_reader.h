// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "files/sampled_rows.h"

namespace metamer::spectral {

/// readCsv with the scale known from elsewhere (a manifest).
std::vector<Spectrum> readCsvOfScale(std::string_view text, const std::string& where, SpectralQuantity quantity,
                                     StatedScale scale);

/// One curve of a table: what stands in the others is not judged.
/// @param column  as columnIndex() takes it
Spectrum readCsvColumn(std::string_view text, const std::string& where, SpectralQuantity quantity,
                       const std::string& column);

}  // namespace metamer::spectral
