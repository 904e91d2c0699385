// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "metamer/sip/recipe.h"
#include "metamer/spectral/data_library.h"

namespace metamer::validation {

struct ValidationOptions {
  int replicates = 8;  ///< renders with seeds of their own, at least 3: their spread is the interval
  int samples = 64;    ///< paths a pixel in each
  std::uint32_t seed = 1;
  int threads = 0;  ///< 0: all
};

/// One patch: rendered under the input light, transformed, and compared with the render under the output light.
struct PatchValidation {
  std::string name;
  double total = 0;           ///< CIEDE2000 of the baked transform
  double engine = 0;          ///< of the exact engine
  double metamerism = 0;      ///< of the exact engine on the patch's own spectrum, without a render
  double representation = 0;  ///< between the baked transform and the engine
  double noise = 0;           ///< 95 % interval of `total`
};

struct SceneValidation {
  std::string name;
  std::string about;
  bool isInterreflecting = false;
  std::vector<PatchValidation> patches;
};

/// A chart lit by an RGB wall against the same chart in daylight, seen by the camera of the recipe's input.
struct WallValidation {
  struct Patch {
    std::string name;
    double drivenOnly = 0;  ///< CIEDE2000 with M alone
    double corrected = 0;   ///< with Q after the camera
    double noise = 0;       ///< 95 % interval
  };
  std::vector<Patch> patches;
  double frustumError = 0;     ///< largest change of a background colour sent through N, wall, camera and Q
  double predictionError = 0;  ///< largest CIEDE2000 between the predicted chart and the rendered one
};

struct Validation {
  std::vector<SceneValidation> scenes;
  WallValidation wall;
};

/// Closes the loop (course notes, section 5.3): scenes that the reference renderer shows under both lights of a recipe.
/// @throws spectral::InputError as sip::resolve
Validation validate(const sip::Recipe& recipe, const spectral::DataLibrary& library, const ValidationOptions& options);

}  // namespace metamer::validation
