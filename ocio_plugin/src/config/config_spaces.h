// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "metamer/spectral/chromatic_adaptation.h"
#include "metamer/spectral/data_library.h"

namespace metamer::ocio {

/// A scene-referred colour space that new configs have, under the name and aliases of OCIO's own studio configs.
struct ConfigSpace {
  std::string name;
  std::vector<std::string> aliases;
  std::string family;
  std::string builtIn;  ///< the same space in metamer (lutgen list spaces); empty: metamer has none
  std::string style;    ///< OCIO 2.1's built-in transform to ACES2065-1; empty: a curve and a matrix of ours
  spectral::ChromaticAdaptation cat = spectral::ChromaticAdaptation::Bradford;  ///< from its white to that of ACES
};

/// All, ACES2065-1 first.
const std::vector<ConfigSpace>& configSpaces();

/// What configs call a built-in space, the likeliest name first; empty for a space that is not built in.
std::vector<std::string> namesInConfigs(const std::string& builtInSpace);

/// Linear ACES2065-1 from a linear built-in space, with the adaptation that OCIO's configs take for it.
Eigen::Matrix3d acesFromLinear(const spectral::RgbSpace& space, const spectral::DataLibrary& library);

}  // namespace metamer::ocio
