// SPDX-License-Identifier: Apache-2.0
#include "metamer/spectral/yaml_section.h"

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <set>
#include <system_error>
#include <utility>
#include <vector>

#include "metamer/spectral/near_names.h"
#include "metamer/spectral/text.h"

namespace metamer::spectral {
YamlSection::YamlSection(const YamlNode& node, std::string where, std::string path,
                         std::initializer_list<const char*> keys, const std::string& document)
    : m_node(node), m_where(std::move(where)), m_path(std::move(path)) {
  const std::vector<std::string> known(keys.begin(), keys.end());
  if (node.kind != YamlNode::Kind::Map) {
    throw error(node, m_path.empty() ? document : m_path, node.text,
                "must be a map of " + joined(known) +
                    (m_path.empty() || document == "recipe"
                         ? ", such as '" + (document == "recipe" ? "metamer" : "metamer_" + document) + ": 1'"
                         : std::string()));
  }
  std::set<std::string> seen;
  for (const YamlMember& member : node.members) {
    const auto& key = member.key;
    const auto& value = member.value;
    if (std::find(known.begin(), known.end(), key) == known.end()) {
      const auto near = nearNames(key, known, 2);
      throw error(value, "key", named(key),
                  "unknown; " + (near.empty() ? std::string() : "did you mean '" + near.front() + "'? ") +
                      "the keys here are " + joined(known));
    }
    if (!seen.insert(key).second) {
      throw error(value, "key", named(key), "is given twice; keep one");
    }
  }
}

const YamlNode* YamlSection::find(const std::string& key) const {
  return m_node.find(key);
}

const YamlNode& YamlSection::require(const std::string& key, const std::string& remedy) const {
  const YamlNode* node = find(key);
  if (node == nullptr) {
    throw error(m_node, named(key), "", remedy);
  }
  return *node;
}

std::string YamlSection::text(const YamlNode& node, const std::string& key) const {
  if (node.kind == YamlNode::Kind::Sequence || node.kind == YamlNode::Kind::Map) {
    throw error(node, named(key), node.text, "must be a name, not a " + node.kindName());
  }
  if (node.text.empty()) {
    throw error(node, named(key), "", "is empty; give a name or leave the key out");
  }
  return node.text;
}

double YamlSection::number(const YamlNode& node, const std::string& key, double low, double high) const {
  char range[64];
  std::snprintf(range, sizeof range, "must be a number from %g to %g", low, high);
  double value = 0;
  const char* end = node.text.data() + node.text.size();
  const auto parsed = std::from_chars(node.text.data(), end, value);
  if (node.kind != YamlNode::Kind::Scalar || node.quoted || parsed.ec != std::errc() || parsed.ptr != end ||
      !(value >= low && value <= high)) {
    throw error(node, named(key), node.text, range);
  }
  return value;
}

void YamlSection::read(const std::string& key, std::string& target) const {
  if (const YamlNode* node = find(key)) {
    target = text(*node, key);
  }
}

void YamlSection::read(const std::string& key, double& target, double low, double high) const {
  if (const YamlNode* node = find(key)) {
    target = number(*node, key, low, high);
  }
}

void YamlSection::read(const std::string& key, bool& target) const {
  if (const YamlNode* node = find(key)) {
    if (node->kind != YamlNode::Kind::Scalar || (node->text != "true" && node->text != "false")) {
      throw error(*node, named(key), node->text, "must be true or false");
    }
    target = node->text == "true";
  }
}

InputError YamlSection::error(const YamlNode& node, const std::string& field, const std::string& value,
                              const std::string& remedy) const {
  return InputError(m_where + ":" + std::to_string(node.line), field, value, remedy);
}

}  // namespace metamer::spectral
