// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene_file/scene_spectra.h"

namespace metamer::spectral_ref {

/// `skin: {melanin, blood, thickness, melanin_type, deoxygenation}`: Lambert's reflector with the skin model's albedo,
/// its mean misfit to people repaired. What is left out is the mean skin's. The shine of a surface is not in it.
Material readSkin(const YamlValue& value, SceneSpectra& spectra);

}  // namespace metamer::spectral_ref
