// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene_file/scene_spectra.h"

namespace metamer::spectral_ref {

/// Keys of a shape that say what it is made of.
inline constexpr const char* kSurfaceKeys[] = {"diffuse",    "skin", "fluorescent", "conductor",
                                               "dielectric", "gel",  "emission"};

/// The material and emission of a shape.
/// @param place  of a picture on the shape
Surface readSurface(const YamlMap& shape, const Texture& place, SceneSpectra& spectra, Scene& scene);

/// Adds a diffuse material.
std::uint32_t addDiffuse(Scene& scene, SpectrumId reflectance);

}  // namespace metamer::spectral_ref
