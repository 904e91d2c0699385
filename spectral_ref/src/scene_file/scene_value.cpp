// SPDX-License-Identifier: Apache-2.0
#include "scene_file/scene_value.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <system_error>

#include "metamer/spectral/near_names.h"
#include "metamer/spectral/text.h"

namespace metamer::spectral_ref {
namespace {

using spectral::InputError;

bool wholeNumber(const std::string& text, double& value) {
  const char* end = text.data() + text.size();
  const char* begin = text.data() + (!text.empty() && text.front() == '+' ? 1 : 0);
  const auto parsed = std::from_chars(begin, end, value);
  return parsed.ec == std::errc() && parsed.ptr == end && std::isfinite(value);
}

std::string rangeText(double low, double high) {
  if (low == -SceneValue::kAny && high == SceneValue::kAny) {
    return "must be a finite number";
  }
  if (high == SceneValue::kAny) {
    return "must be a finite number, " + spectral::shortestNumber(low) + " or more";
  }
  return "must be a number from " + spectral::shortestNumber(low) + " to " + spectral::shortestNumber(high);
}

}  // namespace

InputError SceneValue::error(const std::string& value, const std::string& remedy) const {
  return InputError(place(m_node->line, m_node->column), m_field, value, remedy);
}

std::string SceneValue::place(int line, int column) const {
  return m_where + ":" + std::to_string(line) + ":" + std::to_string(column);
}

SceneValue SceneValue::ofText(const std::string& text, const std::string& field) {
  spectral::YamlNode node;
  node.kind = Kind::Scalar;
  node.text = text;
  return {std::make_shared<const spectral::YamlNode>(std::move(node)), "", field};
}

std::string SceneValue::text() const {
  if (!isScalar() || scalarText().empty()) {
    throw error("must be a name");
  }
  return scalarText();
}

bool SceneValue::isNumber() const {
  double value = 0;
  return isScalar() && wholeNumber(scalarText(), value);
}

double SceneValue::number(double low, double high) const {
  double value = 0;
  if (!isScalar() || !wholeNumber(scalarText(), value) || !(value >= low && value <= high)) {
    throw error(rangeText(low, high));
  }
  return value;
}

int SceneValue::integer(int low, int high) const {
  double value = 0;
  if (!isScalar() || !wholeNumber(scalarText(), value) || !(value >= low && value <= high) ||
      value != std::floor(value)) {
    throw error("must be a whole number from " + std::to_string(low) + " to " + std::to_string(high));
  }
  return static_cast<int>(value);
}

bool SceneValue::boolean() const {
  if (!isScalar() || (scalarText() != "true" && scalarText() != "false")) {
    throw error("must be true or false");
  }
  return scalarText() == "true";
}

std::vector<SceneValue> SceneValue::items() const {
  if (!isSequence()) {
    throw error("must be a list");
  }
  std::vector<SceneValue> result;
  for (std::size_t i = 0; i < m_node->items.size(); ++i) {
    result.push_back(part(m_node->items[i], m_field + "[" + std::to_string(i) + "]"));
  }
  return result;
}

std::vector<double> SceneValue::numbers(double low, double high) const {
  std::vector<double> result;
  for (const SceneValue& item : items()) {
    result.push_back(item.number(low, high));
  }
  return result;
}

Vector3 SceneValue::vector() const {
  // Far beyond any scene, well within single precision.
  constexpr double kFarthest = 1e9;
  const std::vector<double> values = numbers(-kFarthest, kFarthest);
  if (values.size() != 3) {
    throw error("must be three numbers, such as [0, 0, 1]");
  }
  return {values[0], values[1], values[2]};
}

SceneSection::SceneSection(const SceneValue& value, std::initializer_list<const char*> keys) : SceneValue(value) {
  const std::vector<std::string> known(keys.begin(), keys.end());
  if (!isMap()) {
    throw error("must be a map of " + spectral::joined(known));
  }
  const auto complaint = [&](const spectral::YamlMember& member, const std::string& remedy) {
    return InputError(place(member.line, member.column), m_field.empty() ? "key" : m_field, member.key, remedy);
  };
  for (const spectral::YamlMember& member : m_node->members) {
    const std::string& name = member.key;
    if (name.empty()) {
      throw complaint(member, "must be a name");
    }
    if (std::find(known.begin(), known.end(), name) == known.end() && !known.empty()) {
      const auto near = spectral::nearNames(name, known, 1);
      throw complaint(member, "unknown; " + (near.empty() ? std::string() : "did you mean '" + near.front() + "'? ") +
                                  "the keys here are " + spectral::joined(known));
    }
    if (std::find(m_keys.begin(), m_keys.end(), name) != m_keys.end()) {
      throw complaint(member, "is given twice; keep one");
    }
    m_keys.push_back(name);
  }
}

std::optional<SceneValue> SceneSection::find(const std::string& key) const {
  const spectral::YamlNode* const child = m_node->find(key);
  if (child == nullptr) {
    return std::nullopt;
  }
  return part(*child, m_field.empty() ? key : m_field + "." + key);
}

SceneValue SceneSection::require(const std::string& key, const std::string& remedy) const {
  const auto value = find(key);
  if (!value) {
    throw InputError(place(m_node->line, m_node->column), m_field.empty() ? key : m_field + "." + key, "", remedy);
  }
  return *value;
}

SceneValue parseSceneText(const std::string& text, const std::string& where) {
  // Far more than any scene has, and the parser's stack holds it.
  constexpr int kDeepest = 64;
  constexpr int kMostNodes = 4'000'000;
  spectral::YamlNode document = spectral::parseYaml(
      text, where, {.name = "scene", .deepest = kDeepest, .mostNodes = kMostNodes, .saysColumns = true});
  if (document.kind == spectral::YamlNode::Kind::Null) {
    throw InputError(where, "scene", "", "is empty; a scene starts with 'metamer_scene: 1'");
  }
  return {std::make_shared<const spectral::YamlNode>(std::move(document)), where, ""};
}

}  // namespace metamer::spectral_ref
