// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <string>
#include <utility>
#include <vector>

#include "metamer/sip/spectral_transform.h"
#include "sip/sip_fixture.h"

namespace metamer::sip {

/// Colours of everyday and worse: inside the gamut, on its border, far outside it.
std::vector<Eigen::Vector3d> colours(int count, unsigned seed = 3);

std::string pairName(const std::pair<std::string, std::string>& pair);

/// Response of a pipeline to a reflectance on the domain, as RGB that the input side of `transform` stands for.
Eigen::Vector3d inputRgb(const TransformSpec& spec, const SpectralTransform& transform,
                         const spectral::DomainSamples& reflectance);

/// What the output side makes of a reflectance, by the definition: CAT with the gain of `adaptation`, on XYZ.
Eigen::Vector3d outputRgb(const TransformSpec& spec, const spectral::DomainSamples& reflectance);

}  // namespace metamer::sip
