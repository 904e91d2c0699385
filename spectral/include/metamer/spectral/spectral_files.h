// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "metamer/spectral/spectral_picture.h"
#include "metamer/spectral/spectrum.h"

namespace metamer::spectral {

/// Largest file any reader takes, bytes; larger ones are refused by name and size.
inline constexpr std::uintmax_t kLargestFileBytes = 64u << 20;

/// A file, or one curve of it: "lamps.csv", "lamps.csv:warm", "lamps.csv:2", "hdri.exr:120,80".
struct SpectralFileName {
  std::string file;
  std::string column;  ///< name or number, from 1, of a curve; empty for all
};

/// Splits at the first colon behind a spectral extension. Any other text is a file as it stands.
SpectralFileName spectralFileName(const std::string& text);

/// Whether a file's extension is one that readSpectralFile takes, in any case of letters; a column may follow.
bool hasSpectralExtension(const std::filesystem::path& file);

/// Whether a text given where a name or a file may stand is a file: it has a path separator or such an extension.
bool looksLikeSpectralFile(const std::string& nameOrFile);

/// Reads the spectra of a file, or the one that FILE:COLUMN names, by its extension:
///   .csv .txt .tsv .tab .dat .prn .asc .xls (text)  tables as meters and spreadsheets write them; see readCsv
///   .sp .ti3 .ccss .cgats  CGATS, as Argyll and i1Profiler write it; read under the extensions above as well
///   .spdx                  IES TM-27-14 XML
///   .json                  rawtoaces measurement JSON
///   .exr                   a spectral picture, its mean or FILE:x,y, by the caller's reader of pictures
/// Of a table's columns the one that FILE:COLUMN names alone is judged.
/// @param file      FILE or FILE:COLUMN, see SpectralFileName
/// @param quantity  what the caller asks for; a file that states another quantity is refused
/// @param pictures  reads .exr; without it they are refused
/// @throws InputError naming the file, the line or field, the value and the remedy; the columns where COLUMN is none
std::vector<Spectrum> readSpectralFile(const std::filesystem::path& file, SpectralQuantity quantity,
                                       const PictureChannelReader& pictures = {});

/// The curves' names, for a message: "warm, cool". Long lists are cut.
std::string columnsText(const std::vector<Spectrum>& spectra);

/// The readers behind it, on text already in memory (`where` is what messages call it).
///
/// Tables: UTF-8, UTF-16 with its mark, or Latin-1. Cells separated by comma, semicolon, tab or white space, as `sep=`
/// or the first row with a wavelength tells; a decimal comma where commas do not separate. Blank lines and comments (#
/// ;
/// // % !) are skipped. Layouts: curves in columns, below a preamble and header rows (names, units), above a summary;
/// rows that carry a unit or a label ("380nm", "Spectral Data 380[nm]"), of repeated blocks the finest; curves in rows
/// under a row of wavelengths; CGATS. Any interval, irregular too, in rising or falling order; wavelengths in nm, or in
/// micrometres or Angstrom where a header or cell says so. Reflectances and transmittances in percent where the header
/// says '%' or 'percent', or any value exceeds 2 (a value between 1.2 and 2 is refused as unclear).
/// Samples outside 380 to 780 nm that nothing reads are not judged. Noise below zero, to 5 % of the peak, becomes 0 and
/// a note; an empty cell ends a sensitivity.
/// Refused: no rows, one column, a broken row, a duplicate wavelength, an order that changes, what is no number or
/// below noise within the range, over one million rows.
std::vector<Spectrum> readCsv(const std::string& text, const std::string& where, SpectralQuantity quantity);
std::vector<Spectrum> readSpdx(const std::string& text, const std::string& where, SpectralQuantity quantity);
std::vector<Spectrum> readRawtoacesJson(const std::string& text, const std::string& where, SpectralQuantity quantity);

/// The whole of a regular file as bytes.
/// @throws MissingFileError; InputError (a folder, unreadable, over kLargestFileBytes)
std::string readTextFile(const std::filesystem::path& file);

}  // namespace metamer::spectral
