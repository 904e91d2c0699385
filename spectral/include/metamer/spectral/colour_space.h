// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "metamer/spectral/log_encoding.h"
#include "metamer/spectral/rgb_space.h"

namespace metamer::spectral {

/// A working space: linear RGB, with a log curve a channel where the pixels are encoded.
struct ColourSpace {
  std::string name;
  RgbSpace linear;
  std::optional<LogEncoding> encoding;
};

/// Log spaces and the linear space each encodes: "ACEScct" is AP1, "ARRI LogC3" is ARRI Wide Gamut 3,
/// "ARRI LogC4", "S-Log3 S-Gamut3", "S-Log3 S-Gamut3.Cine", "V-Log V-Gamut", "Log3G10 REDWideGamutRGB",
/// "Canon Log 2 Cinema Gamut", "Canon Log 3 Cinema Gamut", "DaVinci Intermediate". Then every linear RGB space
/// under its own name.
std::vector<ColourSpace> colourSpaces(const std::vector<RgbSpace>& linearSpaces);

}  // namespace metamer::spectral
