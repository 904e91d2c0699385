// SPDX-License-Identifier: Apache-2.0
#include "scene_file/yaml_section.h"

#include <yaml-cpp/eventhandler.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>
#include <system_error>

#include "metamer/spectral/near_names.h"
#include "metamer/spectral/text.h"

namespace metamer::spectral_ref {
namespace {

using spectral::InputError;

std::string place(const std::string& where, const YAML::Mark& mark) {
  return where + ":" + std::to_string(std::max(mark.line, 0) + 1) + ":" + std::to_string(std::max(mark.column, 0) + 1);
}

bool wholeNumber(const std::string& text, double& value) {
  const char* end = text.data() + text.size();
  const char* begin = text.data() + (!text.empty() && text.front() == '+' ? 1 : 0);
  const auto parsed = std::from_chars(begin, end, value);
  return parsed.ec == std::errc() && parsed.ptr == end && std::isfinite(value);
}

std::string rangeText(double low, double high) {
  if (low == -YamlValue::kAny && high == YamlValue::kAny) {
    return "must be a finite number";
  }
  if (high == YamlValue::kAny) {
    return "must be a finite number, " + spectral::shortestNumber(low) + " or more";
  }
  return "must be a number from " + spectral::shortestNumber(low) + " to " + spectral::shortestNumber(high);
}

/// Takes no notice of what is parsed.
class Ignored : public YAML::EventHandler {
 public:
  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark&, YAML::anchor_t) override {}
  void OnAlias(const YAML::Mark&, YAML::anchor_t) override {}
  void OnScalar(const YAML::Mark&, const std::string&, YAML::anchor_t, const std::string&) override {}
  void OnSequenceStart(const YAML::Mark&, const std::string&, YAML::anchor_t, YAML::EmitterStyle::value) override {}
  void OnSequenceEnd() override {}
  void OnMapStart(const YAML::Mark&, const std::string&, YAML::anchor_t, YAML::EmitterStyle::value) override {}
  void OnMapEnd() override {}
};

/// YAML::LoadAll would not do: of a text that begins with a comma it makes documents without end.
bool hasSecondDocument(const std::string& text) {
  std::istringstream stream(text);
  YAML::Parser parser(stream);
  Ignored handler;
  return parser.HandleNextDocument(handler) && parser.HandleNextDocument(handler);
}

}  // namespace

InputError YamlValue::error(const std::string& value, const std::string& remedy) const {
  return InputError(place(m_where, m_node.Mark()), m_field, value, remedy);
}

std::string YamlValue::text() const {
  if (!m_node.IsScalar() || m_node.Scalar().empty()) {
    throw error("must be a name");
  }
  return m_node.Scalar();
}

bool YamlValue::isNumber() const {
  double value = 0;
  return m_node.IsScalar() && wholeNumber(m_node.Scalar(), value);
}

double YamlValue::number(double low, double high) const {
  double value = 0;
  if (!m_node.IsScalar() || !wholeNumber(m_node.Scalar(), value) || !(value >= low && value <= high)) {
    throw error(rangeText(low, high));
  }
  return value;
}

int YamlValue::integer(int low, int high) const {
  double value = 0;
  if (!m_node.IsScalar() || !wholeNumber(m_node.Scalar(), value) || !(value >= low && value <= high) ||
      value != std::floor(value)) {
    throw error("must be a whole number from " + std::to_string(low) + " to " + std::to_string(high));
  }
  return static_cast<int>(value);
}

bool YamlValue::boolean() const {
  if (!m_node.IsScalar() || (m_node.Scalar() != "true" && m_node.Scalar() != "false")) {
    throw error("must be true or false");
  }
  return m_node.Scalar() == "true";
}

std::vector<YamlValue> YamlValue::items() const {
  if (!m_node.IsSequence()) {
    throw error("must be a list");
  }
  std::vector<YamlValue> result;
  for (std::size_t i = 0; i < m_node.size(); ++i) {
    result.emplace_back(m_node[i], m_where, m_field + "[" + std::to_string(i) + "]");
  }
  return result;
}

std::vector<double> YamlValue::numbers(double low, double high) const {
  std::vector<double> result;
  for (const YamlValue& item : items()) {
    result.push_back(item.number(low, high));
  }
  return result;
}

Vector3 YamlValue::vector() const {
  // Far beyond any scene, well within single precision.
  constexpr double kFarthest = 1e9;
  const std::vector<double> values = numbers(-kFarthest, kFarthest);
  if (values.size() != 3) {
    throw error("must be three numbers, such as [0, 0, 1]");
  }
  return {values[0], values[1], values[2]};
}

YamlSection::YamlSection(const YamlValue& value, std::initializer_list<const char*> keys) : YamlValue(value) {
  const std::vector<std::string> known(keys.begin(), keys.end());
  if (!m_node.IsMap()) {
    throw error("must be a map of " + spectral::joined(known));
  }
  for (const auto& member : m_node) {
    const YamlValue key(member.first, m_where, m_field.empty() ? "key" : m_field);
    const std::string name = key.text();
    if (std::find(known.begin(), known.end(), name) == known.end() && !known.empty()) {
      const auto near = spectral::nearNames(name, known, 1);
      throw key.error("unknown; " + (near.empty() ? std::string() : "did you mean '" + near.front() + "'? ") +
                      "the keys here are " + spectral::joined(known));
    }
    if (std::find(m_keys.begin(), m_keys.end(), name) != m_keys.end()) {
      throw key.error("is given twice; keep one");
    }
    m_keys.push_back(name);
  }
}

std::optional<YamlValue> YamlSection::find(const std::string& key) const {
  const YAML::Node child = m_node[key];
  if (!child.IsDefined()) {
    return std::nullopt;
  }
  return YamlValue(child, m_where, m_field.empty() ? key : m_field + "." + key);
}

YamlValue YamlSection::require(const std::string& key, const std::string& remedy) const {
  const auto value = find(key);
  if (!value) {
    throw InputError(place(m_where, m_node.Mark()), m_field.empty() ? key : m_field + "." + key, "", remedy);
  }
  return *value;
}

YamlValue parseYaml(const std::string& text, const std::string& where) {
  try {
    if (hasSecondDocument(text)) {
      throw InputError(where, "scene", "", "holds more than one document; keep one scene a file");
    }
    const YAML::Node document = YAML::Load(text);
    if (document.IsNull()) {
      throw InputError(where, "scene", "", "is empty; a scene starts with 'metamer_scene: 1'");
    }
    return {document, where, ""};
  } catch (const YAML::Exception& error) {
    throw InputError(place(where, error.mark), "YAML", "", error.msg);
  }
}

}  // namespace metamer::spectral_ref
