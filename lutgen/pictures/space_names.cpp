// SPDX-License-Identifier: Apache-2.0
#include "space_names.h"

#include <map>

#include "metamer/spectral/text.h"

namespace metamer::lutgen {

std::string spaceNamedInFile(const std::string& nameInFile) {
  static const std::map<std::string, std::string> names = {
      {"srgb", "sRGB"},
      {"srgb_texture", "sRGB"},
      {"srgb - texture", "sRGB"},
      {"srgb_rec709_scene", "sRGB"},
      {"srgb_rec709_display", "sRGB"},
      {"rec709", "Rec.1886"},
      {"g24_rec709_display", "Rec.1886"},
      {"g22_rec709_scene", "Gamma 2.2"},
      {"g24_rec709_scene", "Gamma 2.4"},
      {"lin_srgb", "Rec.709"},
      {"lin_rec709", "Rec.709"},
      {"lin_rec709_srgb", "Rec.709"},
      {"lin_rec709_scene", "Rec.709"},
      {"lin_rec2020_scene", "Rec.2020"},
      {"lin_p3d65_scene", "P3-D65"},
      {"lin_ap1_scene", "ACEScg"},
      {"lin_ap0_scene", "ACES2065-1"},
      {"acescg", "ACEScg"},
      {"aces2065_1", "ACES2065-1"},
      {"aces2065-1", "ACES2065-1"},
      {"acescct", "ACEScct"},
  };
  const auto found = names.find(spectral::lowerCase(nameInFile));
  return found == names.end() ? "" : found->second;
}

}  // namespace metamer::lutgen
