// SPDX-License-Identifier: Apache-2.0
#include "metamer/ocio/compared_transform.h"

#include <Eigen/LU>
#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "config/config_document.h"
#include "config/config_spaces.h"
#include "metamer/ocio/pixel_processor.h"
#include "metamer/ocio/shaper.h"
#include "metamer/ocio/working_space.h"
#include "metamer/spectral/input_error.h"
#include "metamer/spectral/library_words.h"
#include "metamer/spectral/missing_file_error.h"
#include "metamer/spectral/near_names.h"
#include "metamer/spectral/path_text.h"
#include "metamer/spectral/spectral_files.h"
#include "metamer/spectral/text.h"
#include "operators/interchange.h"
#include "operators/matrix_operator.h"
#include "operators/signal_probes.h"

namespace metamer::ocio {
namespace {

using spectral::InputError;
using PixelFunction = std::function<void(std::span<float> rgba)>;

bool holdsSignal(const std::filesystem::path& file) {
  const std::string extension = spectral::lowerCase(spectral::utf8(file.extension()));
  return extension != ".ctf" && extension != ".clf";
}

PixelFunction throughOcio(const OCIO::ConstTransformRcPtr& transform) {
  const PixelProcessor processor(transform);
  return [processor](std::span<float> rgba) { processor.apply(rgba); };
}

PixelFunction inTurn(std::vector<PixelFunction> functions) {
  return [functions = std::move(functions)](std::span<float> rgba) {
    for (const PixelFunction& function : functions) {
      function(rgba);
    }
  };
}

/// What a certificate says of a file's pixels and range; nothing where there is none.
struct CertifiedPixels {
  std::string space;
  std::string shaper;
  sip::ErrorProtocol::Options probes;
};

std::optional<CertifiedPixels> certifiedPixels(const std::filesystem::path& file) {
  const std::filesystem::path certificate = spectral::pathOf(spectral::utf8(file) + ".json");
  std::error_code none;
  if (!std::filesystem::is_regular_file(certificate, none)) {
    return std::nullopt;
  }
  try {
    const auto json = nlohmann::json::parse(spectral::readTextFile(certificate));
    if (!json.is_object() || !json.contains("metamer_certificate")) {
      return std::nullopt;
    }
    CertifiedPixels pixels;
    pixels.space = json.at("recipe").at("space").get<std::string>();
    pixels.shaper = json.at("transform").value("shaper", "");
    const auto& range = json.at("range");
    pixels.probes.insideGamutOnly = range.at("inside_gamut_only").get<bool>();
    pixels.probes.lowestStop = std::clamp(range.at("lowest_stop").get<int>(), -40, 40);
    pixels.probes.highestStop = std::clamp(range.at("highest_stop").get<int>(), pixels.probes.lowestStop, 40);
    pixels.probes.largestComponent = range.value("largest_component", pixels.probes.largestComponent);
    return pixels;
  } catch (const nlohmann::json::exception& error) {
    throw InputError(spectral::utf8(certificate), "certificate", "",
                     std::string("is not one of metamer's, bake the file again or take it away: ") + error.what());
  }
}

}  // namespace

ComparedTransform comparedRecipe(const sip::Recipe& recipe, const spectral::DataLibrary& library,
                                 const ConfigSource& config) {
  const WorkingSpace working = workingSpaceOf(recipe, library, config);
  ComparedTransform result;
  result.kind = "recipe";
  result.name = recipe.name;
  result.space = working.engine;
  result.spec = sip::resolve(recipe, library, working.engine);
  const auto engine = std::make_shared<const sip::SpectralTransform>(*result.spec, sip::kConvergedBandCount);
  result.apply = [engine](std::span<float> rgba) { engine->apply(rgba); };
  return result;
}

ComparedTransform comparedFile(const std::filesystem::path& file, const LutPixels& pixels,
                               const spectral::DataLibrary& library, const ConfigSource& config) {
  ComparedTransform result;
  result.kind = "LUT file";
  result.name = spectral::utf8(file);
  const PixelProcessor processor = PixelProcessor::fromFile(file);
  const auto certified = certifiedPixels(file);
  const bool isSignal = holdsSignal(file);
  const WorkingSpace working = findWorkingSpace(certified ? certified->space : pixels.space, library, config);
  result.space = working.engine;
  std::vector<PixelFunction> steps;
  if (working.fromEngine) {
    steps.push_back(throughOcio(working.fromEngine));
  }
  const std::string curve = certified ? certified->shaper : pixels.shaper;
  const bool hasShaper = !working.isLog && (isSignal || (!certified && !curve.empty()));
  const Shaper shaper = hasShaper && !curve.empty() ? shaperFromName(curve) : spectral::LogEncoding::AcesCct;
  if (certified) {
    result.probes = certified->probes;
  } else if (hasShaper || isSignal) {
    result.probes = signalProbes(working.encoding ? Shaper(*working.encoding) : shaper);
  }
  if (hasShaper) {
    steps.push_back(throughOcio(shaperTransform(shaper, OCIO::TRANSFORM_DIR_FORWARD)));
  }
  steps.emplace_back([processor](std::span<float> rgba) { processor.apply(rgba); });
  if (hasShaper) {
    steps.push_back(throughOcio(shaperTransform(shaper, OCIO::TRANSFORM_DIR_INVERSE)));
  }
  if (working.toEngine) {
    steps.push_back(throughOcio(working.toEngine));
  }
  result.apply = inTurn(std::move(steps));
  return result;
}

ComparedTransform comparedLook(const std::string& name, const std::string& look, const spectral::DataLibrary& library) {
  const OCIO::ConstConfigRcPtr config = configNamed(name);
  std::vector<std::string> known;
  for (int k = 0; k < config->getNumLooks(); ++k) {
    known.emplace_back(config->getLookNameByIndex(k));
  }
  if (!config->getLook(look.c_str())) {
    throw InputError(name, "look", look, spectral::unknownNameRemedy(look, known, "ociocheck --iconfig " + name));
  }
  if (!config->hasRole(kInterchangeRole)) {
    throw InputError(name, "role", kInterchangeRole,
                     "is missing; add it to the config: it names the config's ACES2065-1");
  }
  ComparedTransform result;
  result.kind = "look";
  result.name = name + ":" + look;
  result.space = library.colourSpace("ACES2065-1").linear;
  auto transform = OCIO::LookTransform::Create();
  transform->setSrc(kInterchangeRole);
  transform->setDst(kInterchangeRole);
  transform->setLooks(look.c_str());
  try {
    result.apply = throughOcio(config->getProcessor(transform)->createGroupTransform());
  } catch (const OCIO::Exception& error) {
    throw InputError(name, "look", look, "cannot be built: " + spectral::colourReason(error.what()));
  }
  return result;
}

ComparedTransform onSpace(const ComparedTransform& transform, const spectral::RgbSpace& space,
                          const spectral::DataLibrary& library) {
  if (transform.space.name == space.name) {
    return transform;
  }
  const Eigen::Matrix3d there = acesFromLinear(transform.space, library).inverse() * acesFromLinear(space, library);
  ComparedTransform result = transform;
  result.space = space;
  result.spec.reset();
  result.apply =
      inTurn({throughOcio(matrixOperator(there)), transform.apply, throughOcio(matrixOperator(there.inverse()))});
  return result;
}

const spectral::RgbSpace& comparisonSpace(const ComparedTransform& a, const ComparedTransform& b) {
  return a.spec || (!b.spec && a.kind != "look") ? a.space : b.space;
}

sip::Comparison compareTransforms(const ComparedTransform& a, const ComparedTransform& b,
                                  const spectral::RgbSpace& space, const spectral::DataLibrary& library) {
  sip::ErrorProtocol::Options options = a.probes;
  options.insideGamutOnly = a.probes.insideGamutOnly || b.probes.insideGamutOnly;
  options.largestComponent = std::min(a.probes.largestComponent, b.probes.largestComponent);
  options.lowestStop = std::max(a.probes.lowestStop, b.probes.lowestStop);
  options.highestStop = std::max(std::min(a.probes.highestStop, b.probes.highestStop), options.lowestStop);
  const ComparedTransform first = onSpace(a, space, library);
  const ComparedTransform second = onSpace(b, space, library);
  sip::Recipe day;
  day.input.illuminant = day.output.illuminant = "D65";
  const sip::TransformSpec spec = first.spec    ? *first.spec
                                  : second.spec ? *second.spec
                                                : sip::resolve(day, library, space);
  const sip::ErrorProtocol protocol(spec, library.reflectances(sip::ErrorProtocol::kChart).samples, options);
  return sip::compareTransforms(space, protocol.probes(), options.lowestStop, options.highestStop, first.apply,
                                second.apply, options.largestComponent);
}

}  // namespace metamer::ocio
