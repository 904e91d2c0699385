// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "metamer/spectral/data_library.h"
#include "metamer/spectral/spectrum.h"

namespace metamer::stage {

/// A single-colour LED as a model: Ohno (2005), "Spectral design considerations for white LED color rendering",
/// (g + 2 g^5) / 3 with g = exp(-((l - peak) / width)^2); 1 at its peak, 360 ... 830 nm every 1 nm.
/// @param peakNm   360 ... 830
/// @param widthNm  half spectral width, 1 ... 300
/// @throws spectral::InputError outside these
spectral::Spectrum ledModel(double peakNm, double widthNm);

/// A phosphor-converted LED as a model: the LED that pumps it, plus a Gaussian phosphor of a full width at half
/// maximum.
/// @param pumpShare  peak of what is left of the pump over the phosphor's, 0 ... 100
spectral::Spectrum phosphorModel(double pumpNm, double pumpWidthNm, double peakNm, double widthNm, double pumpShare);

/// A light of a fixture.
struct Emitter {
  spectral::Spectrum spectrum;
  bool isModel = false;  ///< not measured: reports say so
};

/// "led:PEAK:WIDTH" or "phosphor:PUMP:PUMP_WIDTH:PEAK:WIDTH:PUMP_SHARE", lengths in nm; nothing for other text.
/// @throws spectral::InputError where such a text is malformed
std::optional<Emitter> emitterFromModel(const std::string& text);

/// Emitters by model, name or file; a file gives one a column.
/// @throws spectral::InputError
std::vector<Emitter> emittersFrom(const std::string& text, const spectral::DataLibrary& library,
                                  const std::filesystem::path& folder = {});

}  // namespace metamer::stage
