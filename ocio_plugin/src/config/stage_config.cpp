// SPDX-License-Identifier: Apache-2.0
#include "metamer/ocio/stage_config.h"

#include <yaml-cpp/yaml.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>

#include "config/config_base.h"
#include "config/config_document.h"
#include "config/config_facts.h"
#include "config/config_items.h"
#include "config/config_loader.h"
#include "config/new_config.h"
#include "metamer/spectral/chromatic_adaptation.h"
#include "metamer/spectral/input_error.h"
#include "metamer/spectral/path_text.h"
#include "metamer/spectral/text.h"
#include "operators/interchange.h"

namespace metamer::ocio {
namespace {

using spectral::InputError;

constexpr const char* kFamily = "LED stage";

/// Adapted, so that the camera's white is neutral.
Eigen::Matrix3d acesFromCamera(const StageMatrices& stage, const spectral::DataLibrary& library) {
  const spectral::RgbSpace aces = library.colourSpace(kInterchangeSpace).linear;
  const Eigen::Vector3d white = stage.whiteXyz / stage.whiteXyz.y();
  return aces.rgbFromXyz() * spectral::adaptXyz(spectral::ChromaticAdaptation::Bradford, white, aces.whiteXyz()) *
         stage.xyzFromCamera;
}

bool isReference(const YAML::Node& space) {
  constexpr std::array<const char*, 4> kKeys = {"to_reference", "from_reference", "to_scene_reference",
                                                "from_scene_reference"};
  return std::none_of(kKeys.begin(), kKeys.end(), [&](const char* key) { return space[key].IsDefined(); });
}

/// Colour spaces between which the config's reference becomes ACES2065-1; empty where it is that.
struct Interchange {
  std::string reference;
  std::string aces;
};

Interchange interchangeOf(const ConfigDocument& document, const std::string& where) {
  const ConfigFacts& facts = document.facts();
  const std::string aces = *facts.space(facts.roles.at(kInterchangeRole));
  const YAML::Node root = parseConfigYaml(document.text(), where);
  std::string reference;
  for (const YAML::Node& space : root["colorspaces"]) {
    const std::string name = space["name"].as<std::string>("");
    if (name == aces && isReference(space)) {
      return {};
    }
    if (reference.empty() && isReference(space) && facts.dataSpaces.count(name) == 0) {
      reference = name;
    }
  }
  if (reference.empty()) {
    throw InputError(where, "colorspaces", aces,
                     "is not the config's reference, and no colour space is; add one without transforms");
  }
  return {reference, aces};
}

void emitRow(YAML::Emitter& yaml, const Eigen::Matrix3d& matrix) {
  yaml << YAML::Flow << YAML::BeginSeq;
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column) {
      yaml << spectral::shortestNumber(row < 3 && column < 3 ? matrix(row, column)
                                                             : static_cast<double>(row == column));
    }
  }
  yaml << YAML::EndSeq;
}

void emitMatrix(YAML::Emitter& yaml, const Eigen::Matrix3d& matrix, const Eigen::Vector3d& offset) {
  yaml << YAML::VerbatimTag("MatrixTransform") << YAML::Flow << YAML::BeginMap << YAML::Key << "matrix" << YAML::Value;
  emitRow(yaml, matrix);
  if (!offset.isZero(0)) {
    yaml << YAML::Key << "offset" << YAML::Value << YAML::Flow << YAML::BeginSeq << spectral::shortestNumber(offset[0])
         << spectral::shortestNumber(offset[1]) << spectral::shortestNumber(offset[2]) << "0" << YAML::EndSeq;
  }
  yaml << YAML::EndMap;
}

/// Wall drives from the camera's RGB.
struct Wall {
  Eigen::Matrix3d matrix;
  Eigen::Vector3d offset;
  std::string signalFile;  ///< as the config names it: from drives to what is sent; empty: drives
};

std::string spaceYaml(const std::string& name, const std::string& description, const Interchange& interchange,
                      const Eigen::Matrix3d& cameraFromAces, const Wall* wall) {
  YAML::Emitter yaml;
  yaml << YAML::BeginSeq << YAML::VerbatimTag("ColorSpace") << YAML::Block << YAML::BeginMap;
  const auto pair = [&yaml](const char* key, const std::string& value) {
    yaml << YAML::Key << key << YAML::Value << value;
  };
  pair("name", name);
  pair("family", kFamily);
  pair("bitdepth", "32f");
  pair("description", description);
  pair("isdata", "false");
  if (wall == nullptr || wall->signalFile.empty()) {
    pair("encoding", "scene-linear");
  }
  yaml << YAML::Key << "from_scene_reference" << YAML::Value << YAML::VerbatimTag("GroupTransform") << YAML::Block
       << YAML::BeginMap << YAML::Key << "children" << YAML::Value << YAML::Block << YAML::BeginSeq;
  if (!interchange.reference.empty()) {
    yaml << YAML::VerbatimTag("ColorSpaceTransform") << YAML::Flow << YAML::BeginMap;
    pair("src", interchange.reference);
    pair("dst", interchange.aces);
    yaml << YAML::EndMap;
  }
  emitMatrix(yaml, cameraFromAces, Eigen::Vector3d::Zero());
  if (wall != nullptr) {
    emitMatrix(yaml, wall->matrix, wall->offset);
    yaml << YAML::VerbatimTag("RangeTransform") << YAML::Flow << YAML::BeginMap;
    pair("min_in_value", "0");
    pair("min_out_value", "0");
    yaml << YAML::EndMap;
    if (!wall->signalFile.empty()) {
      yaml << YAML::VerbatimTag("FileTransform") << YAML::Flow << YAML::BeginMap;
      pair("src", wall->signalFile);
      yaml << YAML::EndMap;
    }
  }
  yaml << YAML::EndSeq << YAML::EndMap << YAML::EndMap << YAML::EndSeq;
  return std::string(yaml.c_str()) + "\n";
}

void check(const std::string& name, const ConfigFacts& facts, const std::string& where) {
  if (name.find_first_of(",:|/\\%$+\"\n") != std::string::npos || name.front() == '-' || name.front() == ' ') {
    throw InputError("stage", "name", name,
                     "cannot be part of a look's name: leave out , : | / \\ % $ + \" and a leading -");
  }
  if (facts.taken.count(spectral::lowerCase(name)) != 0 || facts.looks.count(spectral::lowerCase(name)) != 0) {
    throw InputError(where, "name", name, "is in the config already; give the stage another name");
  }
}

/// How a config names a file, and the folder that its search_path needs for it; empty: none.
struct FileName {
  std::string src;
  std::string folder;
};

/// As configs write paths on every system.
std::string slashed(const std::filesystem::path& path) {
  std::string text = spectral::utf8(path);
  std::replace(text.begin(), text.end(), static_cast<char>(std::filesystem::path::preferred_separator), '/');
  return text;
}

FileName nameFor(const std::filesystem::path& file, const std::filesystem::path& config, const ConfigFacts& facts) {
  namespace fs = std::filesystem;
  const fs::path relative = fs::absolute(file).lexically_relative(fs::absolute(config).parent_path());
  const std::string folder = relative.has_parent_path() ? slashed(relative.parent_path()) : ".";
  if (std::find(facts.searchPath.begin(), facts.searchPath.end(), folder) != facts.searchPath.end()) {
    return {spectral::utf8(relative.filename()), ""};
  }
  constexpr const char* kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./";
  if (folder.find_first_not_of(kPlain) != std::string::npos) {
    throw InputError(spectral::utf8(file), "folder", folder,
                     "cannot be added to the config's search_path; write beside it");
  }
  return {spectral::utf8(relative.filename()), folder};
}

}  // namespace

std::string stageConfigText(const StageMatrices& stage, const spectral::DataLibrary& library,
                            const std::filesystem::path& file, const std::filesystem::path& base,
                            const std::filesystem::path& signalFile) {
  const std::string where = base.empty() ? spectral::utf8(file) : spectral::utf8(base);
  const ConfigDocument document =
      base.empty() ? ConfigDocument(newConfigText(stage.name, "LED stage " + stage.name + ", by metamer", "", library),
                                    spectral::utf8(file))
                   : openBaseConfig(base, file);
  const std::string camera = stage.name + " camera";
  const std::string outOfFrustum = stage.name + " wall out of frustum";
  const std::string inFrustum = stage.name + " wall in frustum";
  const ConfigItem correction{stage.name + " post-correction",
                              camera,
                              camera,
                              kFamily,
                              "scene-linear",
                              "Correction of what the camera recorded on the stage (Q)",
                              {ConfigStep(stage.correctedFromCamera)}};
  const std::string outSignal = stage.name + " signal out of frustum";
  const std::string inSignal = stage.name + " signal in frustum";
  for (const std::string& name : {camera, outOfFrustum, inFrustum, outSignal, inSignal, correction.name}) {
    check(name, document.facts(), where);
  }
  const Interchange interchange = interchangeOf(document, where);
  const Eigen::Matrix3d cameraFromAces = acesFromCamera(stage, library).inverse();
  Wall out{stage.wallFromContent, Eigen::Vector3d::Zero(), ""};
  Wall in{stage.frustumFromContent, stage.frustumOffset, ""};
  std::string spaces =
      spaceYaml(camera, "The camera's linear RGB, as recorded", interchange, cameraFromAces, nullptr) + "\n" +
      spaceYaml(outOfFrustum,
                "Linear drives of the wall outside the camera's view (M); put the panel's own curve behind it",
                interchange, cameraFromAces, &out) +
      "\n" +
      spaceYaml(inFrustum,
                "Linear drives of the wall in the camera's view (N and the black offset); put the panel's own curve "
                "behind it",
                interchange, cameraFromAces, &in);
  std::string folder;
  if (!signalFile.empty()) {
    const FileName name = nameFor(signalFile, file, document.facts());
    out.signalFile = in.signalFile = name.src;
    folder = name.folder;
    spaces +=
        "\n" +
        spaceYaml(outSignal, "What the wall is sent outside the camera's view: M, and its EOTF undone", interchange,
                  cameraFromAces, &out) +
        "\n" +
        spaceYaml(inSignal, "What the wall is sent in the camera's view: N, the black offset, and its EOTF undone",
                  interchange, cameraFromAces, &in);
  }
  std::string text = document.with(looksYaml({correction}), "", folder, spaces);
  checkLoads(text, document.facts(), std::filesystem::absolute(file).parent_path(), {}, where);
  return text;
}

}  // namespace metamer::ocio
