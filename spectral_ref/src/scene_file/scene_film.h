// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "metamer/spectral/data_library.h"
#include "metamer/spectral_ref/scene.h"
#include "scene_file/scene_value.h"

namespace metamer::spectral_ref {

/// The `film:`, `camera:` and `integrator:` sections of a scene file; what is left out keeps its default.
FilmSettings readFilm(const std::optional<YamlValue>& value, const spectral::DataLibrary& library,
                      const std::filesystem::path& folder);
CameraSettings readCamera(const std::optional<YamlValue>& value);
IntegratorSettings readIntegrator(const std::optional<YamlValue>& value);

}  // namespace metamer::spectral_ref
