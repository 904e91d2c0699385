// SPDX-License-Identifier: Apache-2.0
#include "metamer/spectral/colour_space.h"

#include <algorithm>
#include <array>

namespace metamer::spectral {
namespace {

struct EncodedSpace {
  const char* name;
  const char* linearName;
  LogEncoding encoding;
};

constexpr std::array<EncodedSpace, 10> kEncodedSpaces{{
    {"ACEScct", "ACEScg", LogEncoding::AcesCct},
    {"ARRI LogC3", "ARRI Wide Gamut 3", LogEncoding::LogC3},
    {"ARRI LogC4", "ARRI Wide Gamut 4", LogEncoding::LogC4},
    {"S-Log3 S-Gamut3", "S-Gamut3", LogEncoding::SLog3},
    {"S-Log3 S-Gamut3.Cine", "S-Gamut3.Cine", LogEncoding::SLog3},
    {"V-Log V-Gamut", "V-Gamut", LogEncoding::VLog},
    {"Log3G10 REDWideGamutRGB", "REDWideGamutRGB", LogEncoding::Log3G10},
    {"Canon Log 2 Cinema Gamut", "Canon Cinema Gamut", LogEncoding::CanonLog2},
    {"Canon Log 3 Cinema Gamut", "Canon Cinema Gamut", LogEncoding::CanonLog3},
    {"DaVinci Intermediate", "DaVinci Wide Gamut", LogEncoding::DaVinciIntermediate},
}};

}  // namespace

std::vector<ColourSpace> colourSpaces(const std::vector<RgbSpace>& linearSpaces) {
  std::vector<ColourSpace> spaces;
  for (const EncodedSpace& encoded : kEncodedSpaces) {
    const auto linear = std::find_if(linearSpaces.begin(), linearSpaces.end(),
                                     [&](const RgbSpace& space) { return space.name == encoded.linearName; });
    if (linear != linearSpaces.end()) {
      spaces.push_back({encoded.name, *linear, encoded.encoding});
    }
  }
  for (const RgbSpace& linear : linearSpaces) {
    spaces.push_back({linear.name, linear, std::nullopt});
  }
  return spaces;
}

}  // namespace metamer::spectral
