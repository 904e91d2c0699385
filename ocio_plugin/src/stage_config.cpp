// SPDX-License-Identifier: Apache-2.0
#include "metamer/ocio/stage_config.h"

#include <Eigen/LU>
#include <sstream>

#include "matrix_operator.h"
#include "metamer/spectral/chromatic_adaptation.h"
#include "metamer/spectral/input_error.h"

namespace metamer::ocio {
namespace {

using spectral::InputError;

constexpr const char* kInterchangeRole = "aces_interchange";
constexpr const char* kInterchangeSpace = "ACES2065-1";
constexpr const char* kFamily = "LED stage";
constexpr const char* kDisplay = "sRGB";

/// Adapted, so that the camera's white is neutral.
Eigen::Matrix3d interchangeFromCamera(const StageMatrices& stage, const spectral::DataLibrary& library) {
  const spectral::RgbSpace aces = library.colourSpace(kInterchangeSpace).linear;
  const Eigen::Vector3d white = stage.whiteXyz / stage.whiteXyz.y();
  return aces.rgbFromXyz() * spectral::adaptXyz(spectral::ChromaticAdaptation::Bradford, white, aces.whiteXyz()) *
         stage.xyzFromCamera;
}

/// To ACES2065-1 from the config's reference; empty where they are the same.
OCIO::TransformRcPtr interchangeFromReference(const OCIO::ConstConfigRcPtr& config) {
  const auto space = config->getColorSpace(kInterchangeRole);
  if (const auto from = space->getTransform(OCIO::COLORSPACE_DIR_FROM_REFERENCE)) {
    return from->createEditableCopy();
  }
  if (const auto to = space->getTransform(OCIO::COLORSPACE_DIR_TO_REFERENCE)) {
    auto inverse = to->createEditableCopy();
    inverse->setDirection(OCIO::GetInverseTransformDirection(inverse->getDirection()));
    return inverse;
  }
  return nullptr;
}

OCIO::ColorSpaceRcPtr spaceOf(const std::string& name, const char* encoding, const std::string& description) {
  auto space = OCIO::ColorSpace::Create();
  space->setName(name.c_str());
  space->setFamily(kFamily);
  space->setBitDepth(OCIO::BIT_DEPTH_F32);
  space->setEncoding(encoding);
  space->setDescription(description.c_str());
  return space;
}

/// From the reference through ACES2065-1 and the camera's RGB to what `last` makes of it.
OCIO::GroupTransformRcPtr fromReference(const OCIO::ConstConfigRcPtr& config, const Eigen::Matrix3d& cameraFromAces,
                                        const OCIO::GroupTransformRcPtr& last) {
  auto group = OCIO::GroupTransform::Create();
  if (const auto first = interchangeFromReference(config)) {
    group->appendTransform(first);
  }
  group->appendTransform(matrixOperator(cameraFromAces));
  for (int k = 0; last && k < last->getNumTransforms(); ++k) {
    group->appendTransform(last->getTransform(k)->createEditableCopy());
  }
  return group;
}

/// A config with little else in it.
OCIO::ConfigRcPtr newConfig(const StageMatrices& stage, const spectral::DataLibrary& library) {
  auto config = OCIO::Config::Create();
  config->setMajorVersion(2);
  config->setMinorVersion(0);
  config->setName(stage.name.c_str());
  config->setDescription(("LED stage " + stage.name + ", by metamer").c_str());
  auto aces = spaceOf(kInterchangeSpace, "scene-linear", "Academy Color Encoding Specification");
  aces->setFamily("ACES");
  config->addColorSpace(aces);
  const spectral::RgbSpace acesRgb = library.colourSpace(kInterchangeSpace).linear;
  const spectral::RgbSpace cgRgb = library.colourSpace("ACEScg").linear;
  auto cg = spaceOf("ACEScg", "scene-linear", "Linear, AP1 primaries");
  cg->setFamily("ACES");
  cg->setTransform(matrixOperator(acesRgb.rgbFromXyz() * cgRgb.xyzFromRgb()), OCIO::COLORSPACE_DIR_TO_REFERENCE);
  config->addColorSpace(cg);
  auto raw = spaceOf("Raw", "data", "Values as they are");
  raw->setFamily("Utility");
  raw->setIsData(true);
  config->addColorSpace(raw);

  const spectral::RgbSpace rec709 = library.colourSpace("Rec.709").linear;
  auto display = spaceOf(kDisplay, "sdr-video", "sRGB without tone mapping");
  display->setFamily("Display");
  auto toDisplay = OCIO::GroupTransform::Create();
  toDisplay->appendTransform(matrixOperator(
      rec709.rgbFromXyz() *
      spectral::adaptXyz(spectral::ChromaticAdaptation::Bradford, acesRgb.whiteXyz(), rec709.whiteXyz()) *
      acesRgb.xyzFromRgb()));
  auto curve = OCIO::ExponentWithLinearTransform::Create();
  constexpr double kGamma[4] = {2.4, 2.4, 2.4, 1};
  constexpr double kOffset[4] = {0.055, 0.055, 0.055, 0};
  curve->setGamma(kGamma);
  curve->setOffset(kOffset);
  curve->setDirection(OCIO::TRANSFORM_DIR_INVERSE);
  toDisplay->appendTransform(curve);
  display->setTransform(toDisplay, OCIO::COLORSPACE_DIR_FROM_REFERENCE);
  config->addColorSpace(display);

  config->setRole(kInterchangeRole, kInterchangeSpace);
  config->setRole("scene_linear", "ACEScg");
  config->setRole("default", "Raw");
  config->setRole("data", "Raw");
  config->addDisplayView(kDisplay, "Post-corrected", kDisplay, (stage.name + " post-correction").c_str());
  config->addDisplayView(kDisplay, "As recorded", kDisplay, "");
  config->addDisplayView(kDisplay, "Raw", "Raw", "");
  return config;
}

OCIO::ConfigRcPtr baseConfig(const std::filesystem::path& base) {
  try {
    const auto config = OCIO::Config::CreateFromFile(base.string().c_str())->createEditableCopy();
    if (!config->hasRole(kInterchangeRole)) {
      throw InputError(base.string(), "role", kInterchangeRole,
                       "is missing; add it to the config: it names the config's ACES2065-1");
    }
    return config;
  } catch (const OCIO::Exception& error) {
    throw InputError(base.string(), "config", "", std::string("cannot be read: ") + error.what());
  }
}

void refuseTaken(const OCIO::ConfigRcPtr& config, const std::filesystem::path& base, const std::string& name) {
  if (config->getColorSpace(name.c_str()) || config->getLook(name.c_str())) {
    throw InputError(base.string(), "name", name, "is in the base config already; give the stage another name");
  }
}

}  // namespace

std::string stageConfigText(const StageMatrices& stage, const spectral::DataLibrary& library,
                            const std::filesystem::path& base) {
  const auto config = base.empty() ? newConfig(stage, library) : baseConfig(base);
  const std::string camera = stage.name + " camera";
  const std::string outOfFrustum = stage.name + " wall out of frustum";
  const std::string inFrustum = stage.name + " wall in frustum";
  const std::string correction = stage.name + " post-correction";
  for (const std::string& name : {camera, outOfFrustum, inFrustum, correction}) {
    refuseTaken(config, base, name);
  }
  const Eigen::Matrix3d cameraFromAces = interchangeFromCamera(stage, library).inverse();

  auto cameraSpace = spaceOf(camera, "scene-linear", "The camera's linear RGB, as recorded");
  cameraSpace->setTransform(fromReference(config, cameraFromAces, nullptr), OCIO::COLORSPACE_DIR_FROM_REFERENCE);
  config->addColorSpace(cameraSpace);
  auto out = spaceOf(outOfFrustum, "scene-linear",
                     "Linear drives of the wall outside the camera's view (M); put the panel's own curve behind it");
  out->setTransform(fromReference(config, cameraFromAces, outOfFrustumTransform(stage)),
                    OCIO::COLORSPACE_DIR_FROM_REFERENCE);
  config->addColorSpace(out);
  auto in =
      spaceOf(inFrustum, "scene-linear",
              "Linear drives of the wall in the camera's view (N and the black offset); put the panel's own curve "
              "behind it");
  in->setTransform(fromReference(config, cameraFromAces, inFrustumTransform(stage)),
                   OCIO::COLORSPACE_DIR_FROM_REFERENCE);
  config->addColorSpace(in);

  auto look = OCIO::Look::Create();
  look->setName(correction.c_str());
  look->setProcessSpace(camera.c_str());
  look->setTransform(postCorrectionTransform(stage));
  look->setDescription("Correction of what the camera recorded on the stage (Q)");
  config->addLook(look);

  std::ostringstream text;
  try {
    config->validate();
    config->serialize(text);
  } catch (const OCIO::Exception& error) {
    throw InputError(base.string(), "config", "", std::string("cannot be written: ") + error.what());
  }
  return std::move(text).str();
}

}  // namespace metamer::ocio
