// SPDX-License-Identifier: Apache-2.0
#include "host/colour_management.h"

#include <array>

namespace metamer::ofx {
namespace {

constexpr const char* kNativeConfig = "ofx-native-v1.5_aces-v1.3_ocio-v2.3";
constexpr const char* kAnySceneLinear = "ofx_scene_linear";

struct NamedSpace {
  const char* native;  ///< name in OFX's native config
  const char* label;   ///< the config's own name for it, which hosts may use as well
  const char* ours;
};

constexpr std::array kSpaces = {
    NamedSpace{"ACEScg", "ACEScg", "ACEScg"},
    NamedSpace{"ACES2065-1", "ACES2065-1", "ACES2065-1"},
    NamedSpace{"lin_rec709_srgb", "Linear Rec.709 (sRGB)", "Rec.709"},
    NamedSpace{"lin_p3d65", "Linear P3-D65", "P3-D65"},
    NamedSpace{"lin_rec2020", "Linear Rec.2020", "Rec.2020"},
    NamedSpace{"lin_arri_wide_gamut_3", "Linear ARRI Wide Gamut 3", "ARRI Wide Gamut 3"},
    NamedSpace{"lin_arri_wide_gamut_4", "Linear ARRI Wide Gamut 4", "ARRI Wide Gamut 4"},
    NamedSpace{"lin_sgamut3", "Linear S-Gamut3", "S-Gamut3"},
    NamedSpace{"lin_sgamut3cine", "Linear S-Gamut3.Cine", "S-Gamut3.Cine"},
    NamedSpace{"lin_vgamut", "Linear V-Gamut", "V-Gamut"},
    NamedSpace{"lin_redwidegamutrgb", "Linear REDWideGamutRGB", "REDWideGamutRGB"},
    NamedSpace{"lin_cinemagamut_d55", "Linear CinemaGamut D55", "Canon Cinema Gamut"},
    NamedSpace{"lin_davinci_widegamut", "Linear DaVinci WideGamut", "DaVinci Wide Gamut"},
    NamedSpace{"ACEScct", "ACEScct", "ACEScct"},
    NamedSpace{"arri_logc3_ei800", "ARRI LogC3 (EI800)", "ARRI LogC3"},
    NamedSpace{"arri_logc4", "ARRI LogC4", "ARRI LogC4"},
    NamedSpace{"slog3_sgamut3", "S-Log3 S-Gamut3", "S-Log3 S-Gamut3"},
    NamedSpace{"slog3_sgamut3cine", "S-Log3 S-Gamut3.Cine", "S-Log3 S-Gamut3.Cine"},
    NamedSpace{"vlog_vgamut", "V-Log V-Gamut", "V-Log V-Gamut"},
    NamedSpace{"log3g10_redwidegamutrgb", "Log3G10 REDWideGamutRGB", "Log3G10 REDWideGamutRGB"},
    NamedSpace{"canonlog2_cinemagamut_d55", "CanonLog2 CinemaGamut D55", "Canon Log 2 Cinema Gamut"},
    NamedSpace{"canonlog3_cinemagamut_d55", "CanonLog3 CinemaGamut D55", "Canon Log 3 Cinema Gamut"},
    NamedSpace{"davinci_intermediate_widegamut", "DaVinci Intermediate WideGamut", "DaVinci Intermediate"},
};

}  // namespace

bool offersColourManagement(const HostSuites& host) {
  const auto style = PropertySet(host, host.hostProperties).findString(kOfxImageEffectPropColourManagementStyle);
  return style && !style->empty() && *style != kOfxImageEffectColourManagementNone;
}

void declareColourManagement(const HostSuites& host, OfxImageEffectHandle descriptor) {
  if (!offersColourManagement(host)) {
    return;
  }
  OfxPropertySetHandle handle = nullptr;
  check(host.effect->getPropertySet(descriptor, &handle), "getPropertySet");
  const PropertySet properties(host, handle);
  properties.trySet(kOfxImageEffectPropColourManagementStyle, kOfxImageEffectColourManagementFull);
  properties.trySet(kOfxImageEffectPropColourManagementAvailableConfigs, kNativeConfig);
}

std::optional<std::string> negotiatedSpace(const HostSuites& host, OfxImageClipHandle clip) {
  OfxPropertySetHandle handle = nullptr;
  if (!offersColourManagement(host) || clip == nullptr ||
      host.effect->clipGetPropertySet(clip, &handle) != kOfxStatOK) {
    return std::nullopt;
  }
  const auto name = PropertySet(host, handle).findString(kOfxImageClipPropColourspace);
  for (const NamedSpace& space : kSpaces) {
    if (name && (*name == space.native || *name == space.label)) {
      return space.ours;
    }
  }
  return std::nullopt;
}

std::vector<std::string> preferredSpaces(const std::string& preferred) {
  std::vector<std::string> names;
  for (const NamedSpace& space : kSpaces) {
    names.insert(preferred == space.ours ? names.begin() : names.end(), space.native);
  }
  names.emplace_back(kAnySceneLinear);
  return names;
}

}  // namespace metamer::ofx
