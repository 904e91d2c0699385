// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "metamer/spectral/spectral_files.h"
#include "refusal.h"

namespace metamer::spectral {

/// Reads the bytes as every quantity. Whatever they are, the reader returns spectra that keep their promises, or throws
/// InputError with one short line; anything else stops the fuzzer.
template <typename Reader>
void fuzzReader(const Reader& reader, const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  for (const SpectralQuantity quantity : {SpectralQuantity::SpectralPowerDistribution, SpectralQuantity::Sensitivity,
                                          SpectralQuantity::Reflectance, SpectralQuantity::Transmittance}) {
    try {
      const std::vector<Spectrum> spectra = reader(text, "input", quantity);
      require(!spectra.empty());
      for (const Spectrum& spectrum : spectra) {
        require(spectrum.onDomain().allFinite());
      }
    } catch (const InputError& error) {
      checkRefusal(error);
    }
  }
}

}  // namespace metamer::spectral
