// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene_file/scene_spectra.h"

namespace metamer::spectral_ref {

/// What `diffuse: {picture: FILE, ...}` says: a material whose reflectance is a picture's, colours by an uplift or
/// spectra as the file has them. Adds the texture to the scene.
/// @param place  of the picture on the shape: all of a texture but the picture itself
Material readTexturedDiffuse(const YamlValue& value, Texture place, SceneSpectra& spectra, Scene& scene);

}  // namespace metamer::spectral_ref
