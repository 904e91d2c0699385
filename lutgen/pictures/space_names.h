// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace metamer::lutgen {

/// What a space is called here that a file calls by a name of OpenImageIO's or the Color Interop Forum's
/// ("srgb_rec709_scene", "lin_ap1_scene"), without regard to case; empty where that is not known.
std::string spaceNamedInFile(const std::string& nameInFile);

}  // namespace metamer::lutgen
