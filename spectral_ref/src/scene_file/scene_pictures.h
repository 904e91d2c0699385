// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene_file/scene_spectra.h"

namespace metamer::spectral_ref {

/// A picture as emitters, from a section with `picture` (a file that OpenImageIO reads, linear), `emitters` (spectra,
/// one a drive), `matrix` (drives from picture channels, rows; without it the first channels are the drives) and
/// `scale`. Without emitters and matrix a spectral picture (channels as in channelWavelengthNm) is the radiance that it
/// holds, and any other is linear Rec.709 light, lifted to the smoothest spectra of its primaries.
EmitterPicture readPicture(const YamlMap& section, SceneSpectra& spectra);

/// A smooth emission, nowhere negative, whose tristimulus (Y = 1 for a radiance of 1) is given: 41 bands of 10 nm.
spectral::DomainSamples smoothestEmission(const Eigen::Vector3d& xyz, const spectral::Observer& observer);

}  // namespace metamer::spectral_ref
