// SPDX-License-Identifier: Apache-2.0
#include "config/new_config.h"

#include <OpenColorIO/OpenColorIO.h>

#include <Eigen/LU>
#include <array>
#include <sstream>

#include "config/config_spaces.h"
#include "metamer/ocio/shaper.h"
#include "operators/matrix_operator.h"

namespace metamer::ocio {
namespace {

constexpr const char* kConnection = "CIE-XYZ-D65";
constexpr const char* kRaw = "Raw";
constexpr const char* kTexture = "sRGB - Texture";
constexpr const char* kUntoned = "Un-tone-mapped";

struct ViewTransform {
  const char* name;
  const char* style;
  const char* description;
};

constexpr std::array<ViewTransform, 5> kViewTransforms{{
    {kUntoned, "UTILITY - ACES-AP0_to_CIE-XYZ-D65_BFD", "Colours as they are, clipped by the display"},
    {"ACES 1.0 - SDR Video", "ACES-OUTPUT - ACES2065-1_to_CIE-XYZ-D65 - SDR-VIDEO_1.0", "ACES 1, SDR D65 video"},
    {"ACES 1.0 - SDR Cinema", "ACES-OUTPUT - ACES2065-1_to_CIE-XYZ-D65 - SDR-CINEMA_1.0", "ACES 1, SDR cinema"},
    {"ACES 1.1 - HDR Video (1000 nits & Rec.2020 lim)",
     "ACES-OUTPUT - ACES2065-1_to_CIE-XYZ-D65 - HDR-VIDEO-1000nit-15nit-REC2020lim_1.1",
     "ACES 1, 1000 nit HDR video, Rec.2020"},
    {"ACES 1.1 - HDR Video (1000 nits & P3 lim)",
     "ACES-OUTPUT - ACES2065-1_to_CIE-XYZ-D65 - HDR-VIDEO-1000nit-15nit-P3lim_1.1", "ACES 1, 1000 nit HDR video, P3"},
}};

struct Display {
  const char* name;
  const char* alias;
  const char* style;
  const char* encoding;
  const char* view;
};

constexpr std::array<Display, 8> kDisplays{{
    {"sRGB - Display", "srgb_display", "DISPLAY - CIE-XYZ-D65_to_sRGB", "sdr-video", "ACES 1.0 - SDR Video"},
    {"Rec.1886 Rec.709 - Display", "rec1886_rec709_display", "DISPLAY - CIE-XYZ-D65_to_REC.1886-REC.709", "sdr-video",
     "ACES 1.0 - SDR Video"},
    {"Rec.1886 Rec.2020 - Display", "rec1886_rec2020_display", "DISPLAY - CIE-XYZ-D65_to_REC.1886-REC.2020",
     "sdr-video", "ACES 1.0 - SDR Video"},
    {"P3-D65 - Display", "p3d65_display", "DISPLAY - CIE-XYZ-D65_to_G2.6-P3-D65", "sdr-video", "ACES 1.0 - SDR Cinema"},
    {"P3-D60 - Display", "p3d60_display", "DISPLAY - CIE-XYZ-D65_to_G2.6-P3-D60-BFD", "sdr-video",
     "ACES 1.0 - SDR Cinema"},
    {"Rec.2100-PQ - Display", "rec2100_pq_display", "DISPLAY - CIE-XYZ-D65_to_REC.2100-PQ", "hdr-video",
     "ACES 1.1 - HDR Video (1000 nits & Rec.2020 lim)"},
    {"Rec.2100-HLG - Display", "rec2100_hlg_display", "DISPLAY - CIE-XYZ-D65_to_REC.2100-HLG-1000nit", "hdr-video",
     "ACES 1.1 - HDR Video (1000 nits & Rec.2020 lim)"},
    {"ST2084-P3-D65 - Display", "st2084_p3d65_display", "DISPLAY - CIE-XYZ-D65_to_ST2084-P3-D65", "hdr-video",
     "ACES 1.1 - HDR Video (1000 nits & P3 lim)"},
}};

OCIO::TransformRcPtr builtIn(const char* style) {
  auto transform = OCIO::BuiltinTransform::Create();
  transform->setStyle(style);
  return transform;
}

OCIO::TransformRcPtr toAces(const ConfigSpace& space, const spectral::DataLibrary& library) {
  if (!space.style.empty()) {
    return builtIn(space.style.c_str());
  }
  const spectral::ColourSpace ours = library.colourSpace(space.builtIn);
  const auto matrix = matrixOperator(acesFromLinear(ours.linear, library));
  if (!ours.encoding) {
    return matrix;
  }
  auto group = OCIO::GroupTransform::Create();
  group->appendTransform(shaperTransform(*ours.encoding, OCIO::TRANSFORM_DIR_INVERSE));
  group->appendTransform(matrix);
  return group;
}

void addSceneSpaces(const OCIO::ConfigRcPtr& config, const spectral::DataLibrary& library) {
  for (const ConfigSpace& space : configSpaces()) {
    const bool isLog = !space.builtIn.empty() ? library.colourSpace(space.builtIn).encoding.has_value() : true;
    auto entry = OCIO::ColorSpace::Create(OCIO::REFERENCE_SPACE_SCENE);
    entry->setName(space.name.c_str());
    for (const std::string& alias : space.aliases) {
      entry->addAlias(alias.c_str());
    }
    entry->setFamily(space.family.c_str());
    entry->setEncoding(isLog ? "log" : "scene-linear");
    entry->addCategory("file-io");
    if (space.name == "ACEScg" || space.name == "ACEScct") {
      entry->addCategory("working-space");
    }
    entry->setBitDepth(OCIO::BIT_DEPTH_F32);
    if (space.style == "IDENTITY") {
      entry->setDescription("The Academy Color Encoding System's reference space");
    } else {
      entry->setDescription(("Convert " + space.name + " to ACES2065-1").c_str());
      entry->setTransform(toAces(space, library), OCIO::COLORSPACE_DIR_TO_REFERENCE);
    }
    config->addColorSpace(entry);
  }
}

void addUtilitySpaces(const OCIO::ConfigRcPtr& config, const spectral::DataLibrary& library) {
  auto texture = OCIO::ColorSpace::Create(OCIO::REFERENCE_SPACE_SCENE);
  texture->setName(kTexture);
  texture->addAlias("srgb_tx");
  texture->addAlias("Utility - sRGB - Texture");
  texture->setFamily("Utility");
  texture->setEncoding("sdr-video");
  texture->addCategory("file-io");
  texture->setBitDepth(OCIO::BIT_DEPTH_F32);
  texture->setDescription("Linear Rec.709 with the sRGB curve: textures and photographs");
  auto curve = OCIO::ExponentWithLinearTransform::Create();
  curve->setGamma({2.4, 2.4, 2.4, 1.0});
  curve->setOffset({0.055, 0.055, 0.055, 0.0});
  auto group = OCIO::GroupTransform::Create();
  group->appendTransform(curve);
  group->appendTransform(matrixOperator(acesFromLinear(library.colourSpace("Rec.709").linear, library)));
  texture->setTransform(group, OCIO::COLORSPACE_DIR_TO_REFERENCE);
  config->addColorSpace(texture);

  auto raw = OCIO::ColorSpace::Create(OCIO::REFERENCE_SPACE_SCENE);
  raw->setName(kRaw);
  raw->addAlias("Utility - Raw");
  raw->setFamily("Utility");
  raw->addCategory("file-io");
  raw->setBitDepth(OCIO::BIT_DEPTH_F32);
  raw->setIsData(true);
  raw->setDescription("Numbers that are no colours");
  config->addColorSpace(raw);
}

void addDisplays(const OCIO::ConfigRcPtr& config) {
  auto connection = OCIO::ColorSpace::Create(OCIO::REFERENCE_SPACE_DISPLAY);
  connection->setName(kConnection);
  connection->addAlias("cie_xyz_d65");
  connection->setBitDepth(OCIO::BIT_DEPTH_F32);
  connection->setEncoding("display-linear");
  connection->setDescription("CIE XYZ, white D65: what displays are connected through");
  config->addColorSpace(connection);

  for (const ViewTransform& view : kViewTransforms) {
    auto transform = OCIO::ViewTransform::Create(OCIO::REFERENCE_SPACE_SCENE);
    transform->setName(view.name);
    transform->setDescription(view.description);
    transform->setTransform(builtIn(view.style), OCIO::VIEWTRANSFORM_DIR_FROM_REFERENCE);
    config->addViewTransform(transform);
    config->addSharedView(view.name, view.name, "<USE_DISPLAY_NAME>", "", "", "");
  }
  config->setDefaultViewTransformName(kUntoned);

  for (const Display& display : kDisplays) {
    auto space = OCIO::ColorSpace::Create(OCIO::REFERENCE_SPACE_DISPLAY);
    space->setName(display.name);
    space->addAlias(display.alias);
    space->setFamily("Display");
    space->setEncoding(display.encoding);
    space->addCategory("file-io");
    space->setBitDepth(OCIO::BIT_DEPTH_F32);
    space->setDescription((std::string("Convert CIE XYZ (D65 white) to ") + display.name).c_str());
    space->setTransform(builtIn(display.style), OCIO::COLORSPACE_DIR_FROM_REFERENCE);
    config->addColorSpace(space);
    config->addDisplaySharedView(display.name, display.view);
    config->addDisplaySharedView(display.name, kUntoned);
    config->addDisplayView(display.name, kRaw, kRaw, "");
  }
}

}  // namespace

std::string newConfigText(const std::string& name, const std::string& description, const std::string& lutPath,
                          const spectral::DataLibrary& library) {
  auto config = OCIO::Config::Create();
  config->setMajorVersion(2);
  config->setMinorVersion(1);
  config->setName(name.c_str());
  config->setDescription(description.c_str());
  config->setSearchPath(lutPath.c_str());
  config->setStrictParsingEnabled(true);

  addSceneSpaces(config, library);
  addUtilitySpaces(config, library);
  addDisplays(config);

  const std::array<std::array<const char*, 2>, 12> roles{{{"default", "ACES2065-1"},
                                                          {"reference", "ACES2065-1"},
                                                          {"rendering", "ACEScg"},
                                                          {"aces_interchange", "ACES2065-1"},
                                                          {"cie_xyz_d65_interchange", kConnection},
                                                          {"scene_linear", "ACEScg"},
                                                          {"compositing_log", "ACEScct"},
                                                          {"color_timing", "ACEScct"},
                                                          {"color_picking", kTexture},
                                                          {"texture_paint", kTexture},
                                                          {"matte_paint", kTexture},
                                                          {"data", kRaw}}};
  for (const auto& role : roles) {
    config->setRole(role[0], role[1]);
  }
  auto rules = OCIO::FileRules::Create();
  rules->setDefaultRuleColorSpace("ACES2065-1");
  config->setFileRules(rules);
  config->setInactiveColorSpaces(kConnection);
  // Programs open with the first.
  std::string views;
  for (std::size_t k = 1; k < kViewTransforms.size(); ++k) {
    views += std::string(kViewTransforms[k].name) + ", ";
  }
  config->setActiveViews((views + kUntoned + ", " + kRaw).c_str());
  config->validate();
  std::ostringstream text;
  config->serialize(text);
  return std::move(text).str();
}

}  // namespace metamer::ocio
