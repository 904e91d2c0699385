// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace metamer::spectral {

/// What OpenImageIO says of a picture that it cannot read, for a message's end: said once, in one line, with what to
/// do.
std::string pictureReason(const std::string& said);

/// What OpenColorIO says of a config or LUT: the reason alone, without absolute paths, its own name's formats that it
/// tried, and what only its developers need. In one line.
std::string colourReason(const std::string& said);

}  // namespace metamer::spectral
