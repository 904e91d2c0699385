// SPDX-License-Identifier: Apache-2.0
#include "config/config_items.h"

#include <yaml-cpp/yaml.h>

#include "metamer/spectral/text.h"

namespace metamer::ocio {
namespace {

void emitMatrix(YAML::Emitter& yaml, const Eigen::Matrix3d& matrix) {
  yaml << YAML::VerbatimTag("MatrixTransform") << YAML::Flow << YAML::BeginMap << YAML::Key << "matrix" << YAML::Value
       << YAML::Flow << YAML::BeginSeq;
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column) {
      yaml << spectral::shortestNumber(row < 3 && column < 3 ? matrix(row, column)
                                                             : static_cast<double>(row == column));
    }
  }
  yaml << YAML::EndSeq << YAML::EndMap;
}

void emitStep(YAML::Emitter& yaml, const ConfigStep& step) {
  if (const auto* matrix = std::get_if<Eigen::Matrix3d>(&step)) {
    emitMatrix(yaml, *matrix);
    return;
  }
  yaml << YAML::VerbatimTag("FileTransform") << YAML::Flow << YAML::BeginMap << YAML::Key << "src" << YAML::Value
       << std::get<std::string>(step) << YAML::Key << "interpolation" << YAML::Value << "tetrahedral" << YAML::EndMap;
}

void emitConversion(YAML::Emitter& yaml, const std::string& from, const std::string& to) {
  yaml << YAML::VerbatimTag("ColorSpaceTransform") << YAML::Flow << YAML::BeginMap << YAML::Key << "src" << YAML::Value
       << from << YAML::Key << "dst" << YAML::Value << to << YAML::EndMap;
}

void emitSteps(YAML::Emitter& yaml, const ConfigItem& item, bool onPixels) {
  const bool converts = onPixels && item.pixelSpace != item.processSpace && !item.steps.empty();
  if (item.steps.empty()) {
    yaml << YAML::VerbatimTag("MatrixTransform") << YAML::Flow << YAML::BeginMap << YAML::EndMap;
    return;
  }
  if (item.steps.size() == 1 && !converts) {
    emitStep(yaml, item.steps.front());
    return;
  }
  yaml << YAML::VerbatimTag("GroupTransform") << YAML::Block << YAML::BeginMap << YAML::Key << "children" << YAML::Value
       << YAML::Block << YAML::BeginSeq;
  if (converts) {
    emitConversion(yaml, item.pixelSpace, item.processSpace);
  }
  for (const ConfigStep& step : item.steps) {
    emitStep(yaml, step);
  }
  if (converts) {
    emitConversion(yaml, item.processSpace, item.pixelSpace);
  }
  yaml << YAML::EndSeq << YAML::EndMap;
}

void emitText(YAML::Emitter& yaml, const char* key, const std::string& text) {
  yaml << YAML::Key << key << YAML::Value;
  if (text.find('\n') != std::string::npos) {
    yaml << YAML::Literal;
  }
  yaml << text;
}

std::string lookYaml(const ConfigItem& item) {
  YAML::Emitter yaml;
  yaml << YAML::BeginSeq << YAML::VerbatimTag("Look") << YAML::Block << YAML::BeginMap;
  emitText(yaml, "name", item.name);
  emitText(yaml, "process_space", item.processSpace);
  emitText(yaml, "description", item.description);
  yaml << YAML::Key << "transform" << YAML::Value;
  emitSteps(yaml, item, false);
  yaml << YAML::EndMap << YAML::EndSeq;
  return std::string(yaml.c_str()) + "\n";
}

std::string namedTransformYaml(const ConfigItem& item) {
  YAML::Emitter yaml;
  yaml << YAML::BeginSeq << YAML::VerbatimTag("NamedTransform") << YAML::Block << YAML::BeginMap;
  emitText(yaml, "name", namedTransformName(item.name));
  emitText(yaml, "description", item.description);
  emitText(yaml, "family", item.family);
  yaml << YAML::Key << "categories" << YAML::Value << YAML::Flow << YAML::BeginSeq << "relight" << YAML::EndSeq;
  if (!item.encoding.empty()) {
    emitText(yaml, "encoding", item.encoding);
  }
  yaml << YAML::Key << "transform" << YAML::Value;
  emitSteps(yaml, item, true);
  yaml << YAML::EndMap << YAML::EndSeq;
  return std::string(yaml.c_str()) + "\n";
}

}  // namespace

std::string namedTransformName(const std::string& look) {
  return look + " - Transform";
}

std::string looksYaml(const std::vector<ConfigItem>& items) {
  std::string text;
  for (const ConfigItem& item : items) {
    text += (text.empty() ? "" : "\n") + lookYaml(item);
  }
  return text;
}

std::string namedTransformsYaml(const std::vector<ConfigItem>& items) {
  std::string text;
  for (const ConfigItem& item : items) {
    text += (text.empty() ? "" : "\n") + namedTransformYaml(item);
  }
  return text;
}

}  // namespace metamer::ocio
