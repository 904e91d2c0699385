// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "effects/catalogue.h"
#include "host/parameter.h"

namespace metamer::ofx {

/// Options that stand before the tables' names in their menus.
inline constexpr const char* kBlackbody = "Blackbody";
inline constexpr const char* kDaylight = "CIE daylight";
inline constexpr const char* kFromFile = "From file";
inline constexpr const char* kNoFilter = "None";
inline constexpr const char* kAsAdaptation = "As chromatic adaptation";
inline constexpr const char* kSmooth = "Smooth";
inline constexpr const char* kDataset = "Data set";
inline constexpr const char* kNatural = "Natural";
inline constexpr const char* kSkin = "Skin";
inline constexpr const char* kPairs = "Pairs";
inline constexpr const char* kMapQuality = "Map";
inline constexpr const char* kExactQuality = "Exact";

/// The parameters of one side of the pipeline have these names after "input" or "output".
inline constexpr const char* kIlluminant = "Illuminant";
inline constexpr const char* kTemperature = "Temperature";
inline constexpr const char* kIlluminantFile = "IlluminantFile";
inline constexpr const char* kFilter = "Filter";
inline constexpr const char* kDensity = "Density";
inline constexpr const char* kFilterFile = "FilterFile";
inline constexpr const char* kObserver = "Observer";
inline constexpr const char* kObserverFile = "ObserverFile";

std::vector<Parameter> spectralTransferParameters(const Catalogue& catalogue);

}  // namespace metamer::ofx
