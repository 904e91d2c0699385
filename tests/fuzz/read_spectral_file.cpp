// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

#include "metamer/spectral/optical_constants.h"
#include "metamer/spectral/spectral_files.h"
#include "refusal.h"
#include "temporary_input.h"

/// Whatever the bytes of a file of any spectral format are, and whichever column is asked for, the doors that lamps,
/// filters and materials come through give spectra that keep their promises, or one short line of error. The first byte
/// is the extension, the second the column.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace metamer;
  using spectral::SpectralQuantity;
  constexpr std::array<const char*, 8> kExtensions = {".csv", ".txt", ".sp", ".ti3", ".spdx", ".json", ".asc", ".xls"};
  constexpr std::array<const char*, 5> kColumns = {"", ":1", ":2", ":warm", ":"};
  if (size < 2) {
    return 0;
  }
  const TemporaryInput input(kExtensions[data[0] % kExtensions.size()], data + 2, size - 2);
  const std::string column = kColumns[data[1] % kColumns.size()];
  for (const SpectralQuantity quantity : {SpectralQuantity::SpectralPowerDistribution, SpectralQuantity::Sensitivity,
                                          SpectralQuantity::Reflectance, SpectralQuantity::Transmittance}) {
    try {
      const auto spectra = spectral::readSpectralFile(input.path().string() + column, quantity);
      require(!spectra.empty() && (column.size() < 2 || spectra.size() == 1));
      for (const spectral::Spectrum& spectrum : spectra) {
        require(spectrum.onDomain().allFinite());
      }
    } catch (const spectral::InputError& error) {
      checkRefusal(error);
    }
  }
  for (const auto part : {spectral::OpticalConstant::Refraction, spectral::OpticalConstant::Extinction}) {
    try {
      require(spectral::readOpticalConstant(input.path(), part).onDomain().allFinite());
    } catch (const spectral::InputError& error) {
      checkRefusal(error);
    }
  }
  return 0;
}
