// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "metamer/spectral/data_library.h"
#include "metamer/stage/emitter_match.h"

namespace metamer::stage {

/// The emitters of a fixture.
struct Fixture {
  std::vector<std::string> names;
  std::vector<bool> models;  ///< not measured
  std::vector<spectral::Spectrum> spectra;
  EmitterColumns columns;
  std::vector<std::string> notes;
};

/// @param texts  names or files, as DataLibrary takes them, or model LEDs
/// @throws spectral::InputError
Fixture readFixture(const std::vector<std::string>& texts, const spectral::DataLibrary& library);

/// A mixed light as a spectrum.
spectral::Spectrum mixedLight(const spectral::DomainSamples& power);

}  // namespace metamer::stage
