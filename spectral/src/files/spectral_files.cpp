// SPDX-License-Identifier: Apache-2.0
#include "metamer/spectral/spectral_files.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <string_view>
#include <system_error>

#include "files/column_choice.h"
#include "files/csv_reader.h"
#include "metamer/spectral/input_error.h"
#include "metamer/spectral/missing_file_error.h"
#include "metamer/spectral/path_text.h"
#include "metamer/spectral/spectral_picture.h"
#include "metamer/spectral/text.h"

namespace metamer::spectral {
namespace {

constexpr std::array<std::string_view, 12> kTables{".csv", ".txt", ".tsv", ".tab", ".dat",  ".prn",
                                                   ".asc", ".xls", ".sp",  ".ti3", ".ccss", ".cgats"};

std::string extensionOf(const std::string& file) {
  return lowerCase(utf8(pathOf(file).extension()));
}

constexpr std::string_view kPicture = ".exr";

bool isTable(const std::string& extension) {
  return std::find(kTables.begin(), kTables.end(), extension) != kTables.end();
}

bool isKnown(const std::string& extension) {
  return isTable(extension) || extension == ".spdx" || extension == ".json" || extension == kPicture;
}

std::vector<std::string> namesOf(const std::vector<Spectrum>& spectra) {
  std::vector<std::string> names;
  for (const Spectrum& spectrum : spectra) {
    names.push_back(spectrum.name());
  }
  return names;
}

std::vector<Spectrum> readWholeFile(const std::string& file, SpectralQuantity quantity) {
  const std::string extension = extensionOf(file);
  const std::string text = readTextFile(pathOf(file));
  return extension == ".spdx"   ? readSpdx(text, file, quantity)
         : extension == ".json" ? readRawtoacesJson(text, file, quantity)
                                : readCsv(text, file, quantity);
}

Spectrum readColumn(const std::string& file, SpectralQuantity quantity, const std::string& column) {
  if (isTable(extensionOf(file))) {
    return readCsvColumn(readTextFile(pathOf(file)), file, quantity, column);
  }
  const std::vector<Spectrum> spectra = readWholeFile(file, quantity);
  return spectra[columnIndex(column, namesOf(spectra), file)];
}

}  // namespace

std::string readTextFile(const std::filesystem::path& file) {
  const std::string where = utf8(file);
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(file, error);
  if (status.type() == std::filesystem::file_type::not_found) {
    throw MissingFileError(where, "", "", "no such file");
  }
  if (std::filesystem::is_directory(status)) {
    throw InputError(where, "", "", "is a folder; give a file");
  }
  if (!std::filesystem::is_regular_file(status)) {
    throw InputError(where, "", "", "is a device or pipe; give a regular file");
  }
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  if (!error && size > kLargestFileBytes) {
    throw InputError(where, "size", std::to_string(size) + " bytes",
                     "more than the " + std::to_string(kLargestFileBytes) + " that are read; resample the spectra");
  }
  std::ifstream stream(file, std::ios::binary);
  std::string text(error ? 0 : static_cast<std::size_t>(size), '\0');
  stream.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (error || !stream || stream.gcount() != static_cast<std::streamsize>(text.size())) {
    throw InputError(where, "", "", "cannot be read; check its permissions");
  }
  return text;
}

SpectralFileName spectralFileName(const std::string& text) {
  for (std::size_t colon = text.find(':'); colon != std::string::npos; colon = text.find(':', colon + 1)) {
    const std::string file = text.substr(0, colon);
    if (colon + 1 < text.size() && isKnown(extensionOf(file))) {
      return {file, text.substr(colon + 1)};
    }
  }
  return {text, ""};
}

bool hasSpectralExtension(const std::filesystem::path& file) {
  return isKnown(extensionOf(spectralFileName(utf8(file)).file));
}

bool looksLikeSpectralFile(const std::string& nameOrFile) {
  return nameOrFile.find_first_of("/\\") != std::string::npos || hasSpectralExtension(pathOf(nameOrFile));
}

std::string columnsText(const std::vector<Spectrum>& spectra) {
  return listedColumns(namesOf(spectra));
}

std::vector<Spectrum> readSpectralFile(const std::filesystem::path& fileOrColumn, SpectralQuantity quantity,
                                       const PictureChannelReader& pictures) {
  const auto [where, column] = spectralFileName(utf8(fileOrColumn));
  if (extensionOf(where) == kPicture) {
    return readSpectralPicture(where, column, quantity, pictures);
  }
  if (!isKnown(extensionOf(where))) {
    throw InputError(where, "extension", extensionOf(where),
                     "must be .csv, .txt, .tsv, .sp, .ti3 (or another table's, see the manual), .spdx, .json or .exr");
  }
  return column.empty() ? readWholeFile(where, quantity) : std::vector<Spectrum>{readColumn(where, quantity, column)};
}

}  // namespace metamer::spectral
