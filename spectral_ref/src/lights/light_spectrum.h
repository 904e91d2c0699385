// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "metamer/spectral/spectrum.h"
#include "metamer/spectral_ref/scene.h"

namespace metamer::spectral_ref {

/// The mean spectrum of a scene's lights times |y| + |r_1| + |r_2| + |r_3|, of luminance and the film's responses: how
/// much a wavelength is likely to count before anything is known about a scene but its lamps. Each spectrum that some
/// light has counts alike, whatever its power: which of them lights a pixel is not known. Zero without lights.
spectral::DomainSamples worthOfLights(const Scene& scene);

/// Mean of the lights' spectra, each on the scale that makes its sum 1; 0 without any.
spectral::ExcitationSamples excitingLight(const Scene& scene);

}  // namespace metamer::spectral_ref
