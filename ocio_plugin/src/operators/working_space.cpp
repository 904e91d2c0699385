// SPDX-License-Identifier: Apache-2.0
#include "metamer/ocio/working_space.h"

#include <array>
#include <cmath>
#include <vector>

#include "metamer/ocio/pixel_processor.h"
#include "metamer/ocio/shaper.h"
#include "metamer/spectral/input_error.h"
#include "metamer/spectral/library_words.h"
#include "metamer/spectral/naming_file.h"
#include "metamer/spectral/near_names.h"
#include "metamer/spectral/text.h"
#include "operators/interchange.h"

namespace metamer::ocio {
namespace {

using spectral::InputError;

/// Whether a gain on the pixels is the same gain on the engine's.
bool keepsGains(const PixelProcessor& toEngine) {
  std::array<float, 8> pixels = {0.2F, 0.15F, 0.1F, 1.0F, 0.8F, 0.6F, 0.4F, 1.0F};
  toEngine.apply(pixels);
  for (std::size_t k = 0; k < 3; ++k) {
    if (!(std::abs(pixels[4 + k] - 4.0F * pixels[k]) <= 1e-4F * std::abs(pixels[4 + k]))) {
      return false;
    }
  }
  return true;
}

WorkingSpace configSpace(const std::string& name, const OCIO::ConstColorSpaceRcPtr& space,
                         const spectral::DataLibrary& library, const OCIO::ConstConfigRcPtr& config,
                         const std::string& configName) {
  if (space->isData()) {
    throw InputError(configName, "space", name, "holds data, not colours; name another space");
  }
  if (!config->hasRole(kInterchangeRole)) {
    throw InputError(configName, "role", kInterchangeRole,
                     "is missing; add it to the config (it names the config's ACES2065-1), or use a built-in space");
  }
  WorkingSpace working;
  working.name = space->getName();
  working.engine = library.colourSpace(kInterchangeSpace).linear;
  try {
    working.toEngine = config->getProcessor(space->getName(), kInterchangeRole)->createGroupTransform();
    working.fromEngine = config->getProcessor(kInterchangeRole, space->getName())->createGroupTransform();
  } catch (const OCIO::Exception& error) {
    throw InputError(configName, "space", name,
                     "cannot be converted, name another or mend the config: " + spectral::colourReason(error.what()));
  }
  working.isLinear = keepsGains(PixelProcessor(working.toEngine));
  working.isLog = !working.isLinear && spectral::lowerCase(space->getEncoding()) == "log";
  return working;
}

}  // namespace

OCIO::GroupTransformRcPtr WorkingSpace::wrapped(const OCIO::GroupTransformRcPtr& group) const {
  if (!toEngine || group->getNumTransforms() == 0) {
    return group;
  }
  auto result = OCIO::GroupTransform::Create();
  result->appendTransform(toEngine->createEditableCopy());
  for (int k = 0; k < group->getNumTransforms(); ++k) {
    result->appendTransform(group->getTransform(k)->createEditableCopy());
  }
  result->appendTransform(fromEngine->createEditableCopy());
  return result;
}

WorkingSpace findWorkingSpace(const std::string& name, const spectral::DataLibrary& library,
                              const ConfigSource& source) {
  std::vector<std::string> known;
  for (const auto& space : library.colourSpaces()) {
    known.push_back(space.name);
    if (spectral::lowerCase(space.name) == spectral::lowerCase(name)) {
      WorkingSpace working;
      working.name = space.name;
      working.engine = space.linear;
      working.encoding = space.encoding;
      working.isLog = space.encoding.has_value();
      working.isLinear = !working.isLog;
      if (space.encoding) {
        working.toEngine = shaperTransform(*space.encoding, OCIO::TRANSFORM_DIR_INVERSE);
        working.fromEngine = shaperTransform(*space.encoding, OCIO::TRANSFORM_DIR_FORWARD);
      }
      return working;
    }
  }
  const OCIO::ConstConfigRcPtr config = source.open();
  if (config) {
    if (const auto space = config->getColorSpace(name.c_str())) {
      return configSpace(name, space, library, config, source.name());
    }
    for (int k = 0; k < config->getNumColorSpaces(); ++k) {
      known.emplace_back(config->getColorSpaceNameByIndex(k));
    }
  }
  throw InputError("", "space", name,
                   spectral::unknownNameRemedy(name, known, "lutgen list spaces") +
                       (config ? "" : "; for a space of a config, set $OCIO"));
}

WorkingSpace workingSpaceOf(const sip::Recipe& recipe, const spectral::DataLibrary& library,
                            const ConfigSource& source) {
  return spectral::namingFile(recipe.where, [&] { return findWorkingSpace(recipe.space, library, source); });
}

}  // namespace metamer::ocio
