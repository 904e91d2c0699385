// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene_file/scene_spectra.h"

namespace metamer::spectral_ref {

/// `fluorescent: {file}`, a matrix or a compact form (spectral/fluorescence.h), or
/// `fluorescent: {reflectance, excitation, emission, quantum_yield}`. Lambert's reflector where nothing is shifted.
Material readFluorescent(const YamlValue& value, SceneSpectra& spectra, Scene& scene);

}  // namespace metamer::spectral_ref
