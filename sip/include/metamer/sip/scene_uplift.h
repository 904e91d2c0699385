// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "metamer/spectral/data_library.h"
#include "metamer/spectral/uplift.h"

namespace metamer::sip {

/// Every uplift by its name: the published ones (spectral::upliftMethodNames()), then the scenes of this engine,
/// "smooth", "natural" and "skin".
const std::vector<std::string>& upliftNames();

/// Whether a name, in whatever letters, is one of the engine's scenes.
bool isSceneUplift(const std::string& name);

/// An uplift by any of these names. A scene's gives a colour the spectrum that a recipe with this scene and daylight
/// gives it: at 380, 385, ..., 780 nm, homogeneous of degree one, so that colours above white have values above 1;
/// below 0 only where no reflectance has the colour. It meets the colour by the engine's integrals.
/// @param weights  as in spectral::makeUplift; the scenes take none
/// @throws spectral::InputError for any other name (lists these), and for weights that a scene is given
std::unique_ptr<spectral::Uplift> makeUplift(const std::string& name, const spectral::DataLibrary& library,
                                             const std::optional<spectral::UpliftWeights>& weights = {});

}  // namespace metamer::sip
