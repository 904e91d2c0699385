// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene_file/scene_spectra.h"

namespace metamer::spectral_ref {

/// One entry of `shapes:` into the scene.
void readShape(const YamlValue& value, SceneSpectra& spectra, Scene& scene);

/// One entry of `lights:` into the scene.
void readLight(const YamlValue& value, SceneSpectra& spectra, Scene& scene);

}  // namespace metamer::spectral_ref
