// SPDX-License-Identifier: Apache-2.0
#include "config/config_spaces.h"

#include <algorithm>

namespace metamer::ocio {
namespace {

using Cat = spectral::ChromaticAdaptation;

const ConfigSpace* spaceOf(const std::string& builtInSpace) {
  const auto& spaces = configSpaces();
  const auto found = std::find_if(spaces.begin(), spaces.end(),
                                  [&](const ConfigSpace& space) { return space.builtIn == builtInSpace; });
  return found == spaces.end() ? nullptr : &*found;
}

}  // namespace

const std::vector<ConfigSpace>& configSpaces() {
  static const std::vector<ConfigSpace> spaces = {
      {"ACES2065-1", {"aces2065_1", "ACES - ACES2065-1", "lin_ap0"}, "ACES", "ACES2065-1", "IDENTITY", Cat::Cat02},
      {"ACEScg", {"ACES - ACEScg", "lin_ap1"}, "ACES", "ACEScg", "ACEScg_to_ACES2065-1", Cat::Cat02},
      {"ACEScct", {"ACES - ACEScct", "acescct_ap1"}, "ACES", "ACEScct", "ACEScct_to_ACES2065-1", Cat::Cat02},
      {"ACEScc", {"ACES - ACEScc", "acescc_ap1"}, "ACES", "", "ACEScc_to_ACES2065-1", Cat::Cat02},
      {"Linear ARRI Wide Gamut 3",
       {"lin_arri_wide_gamut_3", "Input - ARRI - Linear - ALEXA Wide Gamut", "lin_alexawide"},
       "Input/ARRI",
       "ARRI Wide Gamut 3",
       "",
       Cat::Cat02},
      {"ARRI LogC3 (EI800)",
       {"arri_logc3_ei800", "Input - ARRI - V3 LogC (EI800) - Wide Gamut", "logc3ei800_alexawide"},
       "Input/ARRI",
       "ARRI LogC3",
       "ARRI_ALEXA-LOGC-EI800-AWG_to_ACES2065-1",
       Cat::Cat02},
      {"Linear ARRI Wide Gamut 4",
       {"lin_arri_wide_gamut_4", "lin_awg4"},
       "Input/ARRI",
       "ARRI Wide Gamut 4",
       "",
       Cat::Cat02},
      {"ARRI LogC4", {"arri_logc4"}, "Input/ARRI", "ARRI LogC4", "", Cat::Cat02},
      {"Linear DaVinci WideGamut",
       {"lin_davinci_widegamut"},
       "Input/BlackmagicDesign",
       "DaVinci Wide Gamut",
       "",
       Cat::Cat02},
      {"DaVinci Intermediate WideGamut",
       {"davinci_intermediate_widegamut"},
       "Input/BlackmagicDesign",
       "DaVinci Intermediate",
       "",
       Cat::Cat02},
      {"Linear CinemaGamut D55",
       {"lin_cinemagamut_d55", "Input - Canon - Linear - Canon Cinema Gamut Daylight", "lin_canoncgamutday"},
       "Input/Canon",
       "Canon Cinema Gamut",
       "",
       Cat::Cat02},
      {"CanonLog2 CinemaGamut D55",
       {"canonlog2_cinemagamut_d55", "Input - Canon - Canon-Log2 - Cinema Gamut Daylight", "canonlog2_cgamutday"},
       "Input/Canon",
       "Canon Log 2 Cinema Gamut",
       "CANON_CLOG2-CGAMUT_to_ACES2065-1",
       Cat::Cat02},
      {"CanonLog3 CinemaGamut D55",
       {"canonlog3_cinemagamut_d55", "Input - Canon - Canon-Log3 - Cinema Gamut Daylight", "canonlog3_cgamutday"},
       "Input/Canon",
       "Canon Log 3 Cinema Gamut",
       "CANON_CLOG3-CGAMUT_to_ACES2065-1",
       Cat::Cat02},
      {"Linear V-Gamut", {"lin_vgamut", "Input - Panasonic - Linear - V-Gamut"}, "Input/Panasonic", "V-Gamut", ""},
      {"V-Log V-Gamut",
       {"vlog_vgamut", "Input - Panasonic - V-Log - V-Gamut"},
       "Input/Panasonic",
       "V-Log V-Gamut",
       "PANASONIC_VLOG-VGAMUT_to_ACES2065-1"},
      {"Linear REDWideGamutRGB",
       {"lin_redwidegamutrgb", "Input - RED - Linear - REDWideGamutRGB", "lin_rwg"},
       "Input/RED",
       "REDWideGamutRGB",
       ""},
      {"Log3G10 REDWideGamutRGB",
       {"log3g10_redwidegamutrgb", "Input - RED - REDLog3G10 - REDWideGamutRGB", "rl3g10_rwg"},
       "Input/RED",
       "Log3G10 REDWideGamutRGB",
       "RED_LOG3G10-RWG_to_ACES2065-1"},
      {"Linear S-Gamut3",
       {"lin_sgamut3", "Input - Sony - Linear - S-Gamut3"},
       "Input/Sony",
       "S-Gamut3",
       "",
       Cat::Cat02},
      {"S-Log3 S-Gamut3",
       {"slog3_sgamut3", "Input - Sony - S-Log3 - S-Gamut3"},
       "Input/Sony",
       "S-Log3 S-Gamut3",
       "SONY_SLOG3-SGAMUT3_to_ACES2065-1",
       Cat::Cat02},
      {"Linear S-Gamut3.Cine",
       {"lin_sgamut3cine", "Input - Sony - Linear - S-Gamut3.Cine"},
       "Input/Sony",
       "S-Gamut3.Cine",
       "",
       Cat::Cat02},
      {"S-Log3 S-Gamut3.Cine",
       {"slog3_sgamut3cine", "Input - Sony - S-Log3 - S-Gamut3.Cine", "slog3_sgamutcine"},
       "Input/Sony",
       "S-Log3 S-Gamut3.Cine",
       "SONY_SLOG3-SGAMUT3.CINE_to_ACES2065-1",
       Cat::Cat02},
      {"Linear Rec.709 (sRGB)",
       {"lin_rec709_srgb", "lin_rec709", "lin_srgb", "Utility - Linear - sRGB", "Utility - Linear - Rec.709"},
       "Utility",
       "Rec.709",
       ""},
      {"Linear P3-D65", {"lin_p3d65", "lin_displayp3", "Utility - Linear - P3-D65"}, "Utility", "P3-D65", ""},
      {"Linear Rec.2020", {"lin_rec2020", "Utility - Linear - Rec.2020"}, "Utility", "Rec.2020", ""},
  };
  return spaces;
}

std::vector<std::string> namesInConfigs(const std::string& builtInSpace) {
  const ConfigSpace* space = spaceOf(builtInSpace);
  if (space == nullptr || builtInSpace.empty()) {
    return {};
  }
  std::vector<std::string> names = {space->name};
  names.insert(names.end(), space->aliases.begin(), space->aliases.end());
  return names;
}

Eigen::Matrix3d acesFromLinear(const spectral::RgbSpace& space, const spectral::DataLibrary& library) {
  const spectral::RgbSpace aces = library.colourSpace("ACES2065-1").linear;
  if (space.name == aces.name) {
    return Eigen::Matrix3d::Identity();
  }
  const ConfigSpace* entry = spaceOf(space.name);
  const Cat cat = entry != nullptr ? entry->cat : Cat::Bradford;
  return spectral::adaptRgb(cat, space, aces);
}

}  // namespace metamer::ocio
