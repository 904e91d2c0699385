// SPDX-License-Identifier: Apache-2.0
#include "metamer/spectral/spectral_files.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <string_view>
#include <system_error>

#include "metamer/spectral/input_error.h"
#include "metamer/spectral/missing_file_error.h"
#include "metamer/spectral/text.h"

namespace metamer::spectral {

std::string readTextFile(const std::filesystem::path& file) {
  const std::string where = file.string();
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(file, error);
  if (status.type() == std::filesystem::file_type::not_found) {
    throw MissingFileError(where, "", "", "no such file");
  }
  if (std::filesystem::is_directory(status)) {
    throw InputError(where, "", "", "is a folder; give a file");
  }
  if (!std::filesystem::is_regular_file(status)) {
    throw InputError(where, "", "", "cannot be read as a file");
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

bool hasSpectralExtension(const std::filesystem::path& file) {
  constexpr std::array<std::string_view, 5> kExtensions{".csv", ".txt", ".tsv", ".spdx", ".json"};
  return std::find(kExtensions.begin(), kExtensions.end(), lowerCase(file.extension().string())) != kExtensions.end();
}

bool looksLikeSpectralFile(const std::string& nameOrFile) {
  return nameOrFile.find_first_of("/\\") != std::string::npos || hasSpectralExtension(nameOrFile);
}

std::vector<Spectrum> readSpectralFile(const std::filesystem::path& file, SpectralQuantity quantity) {
  const std::string extension = lowerCase(file.extension().string());
  const std::string where = file.string();
  if (extension == ".csv" || extension == ".txt" || extension == ".tsv") {
    return readCsv(readTextFile(file), where, quantity);
  }
  if (extension == ".spdx") {
    return readSpdx(readTextFile(file), where, quantity);
  }
  if (extension == ".json") {
    return readRawtoacesJson(readTextFile(file), where, quantity);
  }
  throw InputError(where, "extension", extension, "must be .csv, .txt, .tsv, .spdx or .json");
}

}  // namespace metamer::spectral
