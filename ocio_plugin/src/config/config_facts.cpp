// SPDX-License-Identifier: Apache-2.0
#include "config/config_facts.h"

#include <algorithm>
#include <charconv>

#include "metamer/spectral/input_error.h"
#include "metamer/spectral/text.h"

namespace metamer::ocio {
namespace {

using spectral::InputError;

/// Far above any config (the largest studio configs have some 10^5 nodes), far below what aliases can blow up to.
constexpr int kMostNodes = 4'000'000;
constexpr int kDeepest = 100;

void countNodes(const YAML::Node& node, const std::string& where, int depth, int& count) {
  if (depth > kDeepest || ++count > kMostNodes) {
    throw InputError(where, "config", "", "is nested too deeply or too large to be an OCIO config");
  }
  if (node.IsSequence()) {
    for (const auto& item : node) {
      countNodes(item, where, depth + 1, count);
    }
  } else if (node.IsMap()) {
    for (const auto& member : node) {
      countNodes(member.first, where, depth + 1, count);
      countNodes(member.second, where, depth + 1, count);
    }
  }
}

/// Text of a key of a map; empty where it is not there or no scalar.
std::string textOf(const YAML::Node& map, const char* key) {
  if (!map.IsMap()) {
    return {};
  }
  const YAML::Node value = map[key];
  return value && value.IsScalar() ? value.Scalar() : std::string();
}

std::vector<std::string> listOf(const YAML::Node& map, const char* key) {
  std::vector<std::string> list;
  const YAML::Node value = map[key];
  if (value && value.IsSequence()) {
    for (const auto& item : value) {
      if (item.IsScalar()) {
        list.push_back(item.Scalar());
      }
    }
  }
  return list;
}

void readVersion(const YAML::Node& root, const std::string& where, ConfigFacts& facts) {
  const std::string version = textOf(root, "ocio_profile_version");
  const char* end = version.data() + version.size();
  const auto major = std::from_chars(version.data(), end, facts.majorVersion);
  bool isNumber = major.ec == std::errc{};
  if (isNumber && major.ptr != end) {
    const auto minor = std::from_chars(major.ptr + 1, end, facts.minorVersion);
    isNumber = *major.ptr == '.' && minor.ec == std::errc{} && minor.ptr == end;
  }
  if (!isNumber || facts.majorVersion < 1) {
    throw InputError(where, "ocio_profile_version", version,
                     version.empty() ? "is missing: this is no OCIO config" : "is no version of an OCIO config");
  }
}

/// Every src of a FileTransform, wherever it stands.
void readFiles(const YAML::Node& node, const std::string& user, ConfigFacts& facts) {
  if (node.IsSequence()) {
    for (const auto& item : node) {
      readFiles(item, user, facts);
    }
  } else if (node.IsMap()) {
    if (node.Tag() == "FileTransform") {
      const std::string file = textOf(node, "src");
      if (!file.empty()) {
        facts.fileUses.push_back({file, user});
        if (std::find(facts.files.begin(), facts.files.end(), file) == facts.files.end()) {
          facts.files.push_back(file);
        }
      }
    }
    for (const auto& member : node) {
      readFiles(member.second, user, facts);
    }
  }
}

/// The same of a whole config, with the looks and named transforms that read them.
void readAllFiles(const YAML::Node& root, ConfigFacts& facts) {
  for (const auto& member : root) {
    const std::string key = member.first.IsScalar() ? member.first.Scalar() : "";
    if ((key == "looks" || key == "named_transforms") && member.second.IsSequence()) {
      for (const auto& item : member.second) {
        readFiles(item, spectral::lowerCase(textOf(item, "name")), facts);
      }
    } else {
      readFiles(member.second, "", facts);
    }
  }
}

void readSpaces(const YAML::Node& root, const char* key, ConfigFacts& facts) {
  const YAML::Node spaces = root[key];
  if (!spaces || !spaces.IsSequence()) {
    return;
  }
  for (const auto& space : spaces) {
    const std::string name = textOf(space, "name");
    if (name.empty()) {
      continue;
    }
    facts.spaceNames.push_back(name);
    facts.spaces.emplace(spectral::lowerCase(name), name);
    facts.taken.insert(spectral::lowerCase(name));
    for (const std::string& alias : listOf(space, "aliases")) {
      facts.spaces.emplace(spectral::lowerCase(alias), name);
      facts.taken.insert(spectral::lowerCase(alias));
    }
    if (spectral::lowerCase(textOf(space, "isdata")) == "true") {
      facts.dataSpaces.insert(name);
    }
  }
}

}  // namespace

std::optional<std::string> ConfigFacts::space(const std::string& name) const {
  const std::string wanted = spectral::lowerCase(name);
  if (const auto found = spaces.find(wanted); found != spaces.end()) {
    return found->second;
  }
  if (const auto role = roles.find(wanted); role != roles.end()) {
    if (const auto found = spaces.find(spectral::lowerCase(role->second)); found != spaces.end()) {
      return found->second;
    }
  }
  return std::nullopt;
}

YAML::Node parseConfigYaml(const std::string& text, const std::string& where) {
  YAML::Node root;
  try {
    root = YAML::Load(text);
  } catch (const YAML::Exception& error) {
    throw InputError(where + ":" + std::to_string(error.mark.line + 1), "config", "", "is no YAML: " + error.msg);
  }
  if (!root.IsMap()) {
    throw InputError(where, "config", "", "is no OCIO config: a map with ocio_profile_version is expected");
  }
  int count = 0;
  countNodes(root, where, 0, count);
  return root;
}

ConfigFacts readConfigFacts(const YAML::Node& root, const std::string& where) {
  ConfigFacts facts;
  readVersion(root, where, facts);
  if (const std::string separator = textOf(root, "family_separator"); separator.size() == 1) {
    facts.familySeparator = separator[0];
  }
  facts.searchPath = searchPathOf(root["search_path"]);
  readSpaces(root, "colorspaces", facts);
  readSpaces(root, "display_colorspaces", facts);
  if (const YAML::Node roles = root["roles"]; roles && roles.IsMap()) {
    for (const auto& role : roles) {
      if (role.first.IsScalar() && role.second.IsScalar()) {
        facts.roles.emplace(spectral::lowerCase(role.first.Scalar()), role.second.Scalar());
        facts.taken.insert(spectral::lowerCase(role.first.Scalar()));
      }
    }
  }
  if (const YAML::Node transforms = root["named_transforms"]; transforms && transforms.IsSequence()) {
    for (const auto& transform : transforms) {
      facts.taken.insert(spectral::lowerCase(textOf(transform, "name")));
      facts.namedTransforms.insert(spectral::lowerCase(textOf(transform, "name")));
      for (const std::string& alias : listOf(transform, "aliases")) {
        facts.taken.insert(spectral::lowerCase(alias));
      }
    }
  }
  if (const YAML::Node looks = root["looks"]; looks && looks.IsSequence()) {
    for (const auto& look : looks) {
      facts.looks.insert(spectral::lowerCase(textOf(look, "name")));
    }
  }
  if (const YAML::Node environment = root["environment"]; environment && environment.IsMap()) {
    for (const auto& variable : environment) {
      if (variable.first.IsScalar() && variable.second.IsScalar()) {
        facts.environment.emplace(variable.first.Scalar(), variable.second.Scalar());
      }
    }
  }
  readAllFiles(root, facts);
  return facts;
}

std::vector<std::string> searchPathOf(const YAML::Node& node) {
  std::vector<std::string> folders;
  if (!node) {
    return folders;
  }
  if (node.IsSequence()) {
    for (const auto& item : node) {
      if (item.IsScalar() && !item.Scalar().empty()) {
        folders.push_back(item.Scalar());
      }
    }
  } else if (node.IsScalar()) {
    std::string folder;
    for (const char c : node.Scalar() + ":") {
      if (c != ':') {
        folder += c;
      } else if (!folder.empty()) {
        folders.push_back(std::move(folder));
        folder.clear();
      }
    }
  }
  return folders;
}

bool isSameYaml(const YAML::Node& a, const YAML::Node& b) {
  if (a.Type() != b.Type() || a.Tag() != b.Tag() || a.size() != b.size()) {
    return false;
  }
  if (a.IsScalar()) {
    return a.Scalar() == b.Scalar();
  }
  auto other = b.begin();
  for (auto one = a.begin(); one != a.end(); ++one, ++other) {
    const bool isSame = a.IsMap() ? isSameYaml(one->first, other->first) && isSameYaml(one->second, other->second)
                                  : isSameYaml(*one, *other);
    if (!isSame) {
      return false;
    }
  }
  return true;
}

}  // namespace metamer::ocio
