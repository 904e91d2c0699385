// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace metamer::spectral {

/// Which curve FILE:COLUMN means: by its name, without regard to case, else by its number from 1.
/// @param names  of the file's curves
/// @throws InputError, naming the file and what it holds: a name of none or of several
std::size_t columnIndex(const std::string& column, const std::vector<std::string>& names, const std::string& file);

/// Names as messages list them: the first dozen.
std::string listedColumns(const std::vector<std::string>& names);

}  // namespace metamer::spectral
