// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "metamer/spectral/spectrum.h"

namespace metamer::spectral {

/// Largest file any reader takes, bytes; larger ones are refused by name and size.
inline constexpr std::uintmax_t kLargestFileBytes = 64u << 20;

/// Whether a file's extension is one that readSpectralFile takes, in any case of letters.
bool hasSpectralExtension(const std::filesystem::path& file);

/// Whether a text given where a name or a file may stand is a file: it has a path separator or such an extension.
bool looksLikeSpectralFile(const std::string& nameOrFile);

/// Reads the spectra of a file, one a data column, by its extension:
///   .csv .txt .tsv  wavelength and one or more values a row; see readCsv
///   .spdx           IES TM-27-14 XML
///   .json           rawtoaces measurement JSON
/// @param quantity  what the caller asks for; a file that states another quantity is refused
/// @throws InputError naming the file, the line or field, the value and the remedy
std::vector<Spectrum> readSpectralFile(const std::filesystem::path& file, SpectralQuantity quantity);

/// The readers behind it, on text already in memory (`where` is what messages call it).
///
/// CSV: delimiter comma, semicolon, tab or white space (told by the first data row); a decimal comma where the
/// delimiter is not a comma; UTF-8 byte order mark; lines that start with '#' and a header row are skipped
/// (the header names the spectra); any interval, irregular too; rows in rising or falling order; wavelengths in nm,
/// or in micrometres or Angstrom where the header says um or angstrom. Reflectances and transmittances in percent
/// where the header says '%' or 'percent', or any value exceeds 2 (a value between 1.2 and 2 is refused as unclear).
/// Refused: no rows, one column, a duplicate wavelength, an order that changes, NaN or infinity,
/// a negative power, text that is not UTF-8, over one million rows.
std::vector<Spectrum> readCsv(const std::string& text, const std::string& where, SpectralQuantity quantity);
std::vector<Spectrum> readSpdx(const std::string& text, const std::string& where, SpectralQuantity quantity);
std::vector<Spectrum> readRawtoacesJson(const std::string& text, const std::string& where, SpectralQuantity quantity);

/// The whole of a regular file as bytes.
/// @throws MissingFileError; InputError (a folder, unreadable, over kLargestFileBytes)
std::string readTextFile(const std::filesystem::path& file);

}  // namespace metamer::spectral
