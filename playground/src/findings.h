// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include "session.h"

namespace metamer::playground {

/// Names of illuminants and filters with their descriptions, and spaces for cubes.
nlohmann::json namesOf(const spectral::DataLibrary& library);

/// Of the session's recipe: `lights`, the spectra of both behind their filters, 380 to 780 nm by 5 nm, the larger peak
/// 1 each; `surfaces`, a chart and skins: as shot, through the engine, truly under the other light, and through plain
/// adaptation (linear RGB of the recipe's space), and the CIEDE2000 of engine and adaptation from the truth.
nlohmann::json findingsOf(const Session& session);

}  // namespace metamer::playground
