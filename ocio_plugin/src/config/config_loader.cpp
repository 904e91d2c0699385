// SPDX-License-Identifier: Apache-2.0
#include "config/config_loader.h"

#include <OpenColorIO/OpenColorIO.h>

#include <set>
#include <sstream>

#include "metamer/spectral/input_error.h"
#include "metamer/spectral/library_words.h"
#include "metamer/spectral/path_text.h"

namespace metamer::ocio {

namespace OCIO = OCIO_NAMESPACE;

namespace {

using spectral::InputError;

bool isKnown(const ConfigFacts& facts) {
  const int version = OCIO::GetVersionHex();
  const int major = version >> 24;
  const int minor = (version >> 16) & 0xff;
  return facts.majorVersion < major || (facts.majorVersion == major && facts.minorVersion <= minor);
}

OCIO::ConfigRcPtr loaded(const std::string& text, const std::filesystem::path& folder) {
  std::istringstream stream(text);
  OCIO::ConfigRcPtr config = OCIO::Config::CreateFromStream(stream)->createEditableCopy();
  config->setWorkingDir(spectral::utf8(folder).c_str());
  return config;
}

/// The items alone, in a config with the spaces that they name.
std::string standIn(const std::vector<ConfigItem>& items, const std::vector<std::string>& searchPath) {
  OCIO::ConfigRcPtr config = OCIO::Config::CreateRaw()->createEditableCopy();
  config->setMajorVersion(2);
  config->setMinorVersion(1);
  std::string path;
  for (const std::string& folder : searchPath) {
    path += (path.empty() ? "" : ":") + folder;
  }
  config->setSearchPath(path.c_str());
  std::set<std::string> names;
  for (const ConfigItem& item : items) {
    names.insert(item.processSpace);
    names.insert(item.pixelSpace);
  }
  for (const std::string& name : names) {
    auto space = OCIO::ColorSpace::Create(OCIO::REFERENCE_SPACE_SCENE);
    space->setName(name.c_str());
    config->addColorSpace(space);
  }
  std::ostringstream text;
  config->serialize(text);
  return ConfigDocument(std::move(text).str(), "new config").with(looksYaml(items), namedTransformsYaml(items), "");
}

void build(const OCIO::ConstConfigRcPtr& config, const ConfigItem& item, const std::string& where) {
  try {
    auto look = OCIO::LookTransform::Create();
    look->setSrc(item.processSpace.c_str());
    look->setDst(item.processSpace.c_str());
    look->setLooks(item.name.c_str());
    config->getProcessor(look)->getDefaultCPUProcessor();
    const auto named = config->getNamedTransform(namedTransformName(item.name).c_str());
    config->getProcessor(named->getTransform(OCIO::TRANSFORM_DIR_FORWARD))->getDefaultCPUProcessor();
  } catch (const OCIO::Exception& error) {
    throw InputError(where, "look", item.name, "cannot be built: " + spectral::colourReason(error.what()));
  }
}

}  // namespace

bool checkLoads(const std::string& text, const ConfigFacts& facts, const std::filesystem::path& folder,
                const std::vector<ConfigItem>& items, const std::string& where) {
  const bool known = isKnown(facts);
  try {
    std::vector<std::string> searchPath = ConfigDocument(text, where).facts().searchPath;
    const OCIO::ConfigRcPtr config = loaded(known ? text : standIn(items, searchPath), folder);
    config->validate();
    for (const ConfigItem& item : items) {
      build(config, item, where);
    }
  } catch (const OCIO::Exception& error) {
    throw InputError(where, "config", "", "OCIO refuses it: " + spectral::colourReason(error.what()));
  }
  return known;
}

}  // namespace metamer::ocio
