// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace metamer::spectral {

/// The bytes of a table as UTF-8 without a byte order mark: UTF-8, UTF-16 with its mark, else Latin-1, as meters'
/// programs and spreadsheets write them.
/// @throws InputError for what is no text: NUL, a spreadsheet program's own file, UTF-16 that ends within a character
std::string decodedTable(std::string_view bytes, const std::string& where);

}  // namespace metamer::spectral
