// SPDX-License-Identifier: Apache-2.0
#include "metamer/spectral/spectral_files.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <optional>
#include <string_view>
#include <system_error>

#include "metamer/spectral/input_error.h"
#include "metamer/spectral/missing_file_error.h"
#include "metamer/spectral/path_text.h"
#include "metamer/spectral/spectral_picture.h"
#include "metamer/spectral/text.h"

namespace metamer::spectral {
namespace {

constexpr std::array<std::string_view, 9> kTables{".csv", ".txt", ".tsv",  ".asc",  ".xls",
                                                  ".sp",  ".ti3", ".ccss", ".cgats"};

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

std::vector<Spectrum> readWholeFile(const std::string& file, SpectralQuantity quantity) {
  const std::string extension = extensionOf(file);
  if (!isKnown(extension)) {
    throw InputError(file, "extension", extension,
                     "must be .csv, .txt, .tsv, .sp, .ti3 (or another table's, see the manual), .spdx, .json or .exr");
  }
  const std::string text = readTextFile(pathOf(file));
  return extension == ".spdx"   ? readSpdx(text, file, quantity)
         : extension == ".json" ? readRawtoacesJson(text, file, quantity)
                                : readCsv(text, file, quantity);
}

/// A curve by its name, without regard to case, else by its number.
Spectrum columnNamed(const std::string& column, const std::vector<Spectrum>& spectra, const std::string& file) {
  const std::string wanted = lowerCase(trimmed(column));
  const Spectrum* found = nullptr;
  for (const Spectrum& spectrum : spectra) {
    if (lowerCase(spectrum.name()) == wanted) {
      if (found != nullptr) {
        throw InputError(file, "column", column, "is the name of several; give the number of one, from 1");
      }
      found = &spectrum;
    }
  }
  const std::optional<double> number = parseNumber(wanted);
  if (found == nullptr && number && *number >= 1 && *number <= static_cast<double>(spectra.size()) &&
      *number == std::floor(*number)) {
    found = &spectra[static_cast<std::size_t>(*number) - 1];
  }
  if (found == nullptr) {
    throw InputError(file, "column", column,
                     "is not there; give a name or a number from 1 of: " + columnsText(spectra));
  }
  return *found;
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
  constexpr std::size_t kMost = 12;
  std::vector<std::string> names;
  for (const Spectrum& spectrum : spectra) {
    if (names.size() == kMost) {
      names.push_back("... " + std::to_string(spectra.size()) + " in all");
      break;
    }
    names.push_back(shortened(spectrum.name(), 24));
  }
  return joined(names);
}

std::vector<Spectrum> readSpectralFile(const std::filesystem::path& fileOrColumn, SpectralQuantity quantity,
                                       const PictureChannelReader& pictures) {
  const auto [where, column] = spectralFileName(utf8(fileOrColumn));
  if (extensionOf(where) == kPicture) {
    return readSpectralPicture(where, column, quantity, pictures);
  }
  std::vector<Spectrum> spectra = readWholeFile(where, quantity);
  return column.empty() ? spectra : std::vector<Spectrum>{columnNamed(column, spectra, where)};
}

}  // namespace metamer::spectral
