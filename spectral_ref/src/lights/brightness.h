// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "lights/light_tree.h"
#include "metamer/spectral_ref/scene.h"

namespace metamer::spectral_ref {

/// About the radiance that a scene's surfaces send, on the scale that makes Y of a radiance of 1 one: what all its
/// lights would give a white surface that faces them, where the camera stands or looks to, whichever is farther from a
/// light. Only its order of magnitude is of use. 1 without any light.
double brightnessOf(const std::vector<LightBounds>& lights, const CameraSettings& camera);

}  // namespace metamer::spectral_ref
