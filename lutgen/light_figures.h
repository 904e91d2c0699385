// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "metamer/spectral/data_library.h"

namespace metamer::lutgen {

/// Adds what a name is: description and words, and figures computed from its table. Of a light: CCT and Duv (CIE 1931
/// 2 degree), and the SSI to its nearest reference, the blackbody or CIE daylight of its CCT. Of a filter: Y of D65's
/// through it, and the CCT of D65 and of illuminant A behind it. CCT is left out where no blackbody is near.
void addDescription(nlohmann::ordered_json& entry, const std::string& kind, const std::string& name,
                    const spectral::DataLibrary& library);

/// The figures of such an entry in a line: "2001 K, Duv +0.0007, SSI 27".
std::string figuresOf(const nlohmann::ordered_json& entry);

}  // namespace metamer::lutgen
