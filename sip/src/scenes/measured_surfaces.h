// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "metamer/spectral/data_library.h"

namespace metamer::sip {

/// The samples of a set on the integration domain.
std::vector<spectral::DomainSamples> onDomain(const spectral::ReflectanceSet& set);

/// Whether a sample is within an rms of 0.02 of one of some: the same paint measured again.
bool hasTwin(const std::vector<spectral::DomainSamples>& samples, const spectral::DomainSamples& sample);

/// All measured reflectances of the library, in the order of its tables, less twins of earlier ones.
std::vector<spectral::DomainSamples> measuredSurfaces(const spectral::DataLibrary& library);

/// Names of the sets to judge by: all but draws of virtual skins, of which there are as many as one wants.
std::vector<std::string> judgedSetNames(const spectral::DataLibrary& library);

/// The library's modelled skins, published with the model.
std::vector<spectral::DomainSamples> modelSkins(const spectral::DataLibrary& library);

/// Draws of metamer::skin, a thousand.
std::vector<spectral::DomainSamples> virtualSkins(const spectral::DataLibrary& library);

}  // namespace metamer::sip
