// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <yaml-cpp/yaml.h>

#include <initializer_list>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "metamer/spectral/input_error.h"
#include "metamer/spectral_ref/scene.h"

namespace metamer::spectral_ref {

/// One value of a scene file, read with checks; every complaint names file, line and column.
class YamlValue {
 public:
  YamlValue(const YAML::Node& node, std::string where, std::string field)
      : m_node(node), m_where(std::move(where)), m_field(std::move(field)) {}

  spectral::InputError error(const std::string& value, const std::string& remedy) const;
  spectral::InputError error(const std::string& remedy) const { return error(scalarText(), remedy); }

  bool isScalar() const { return m_node.IsScalar(); }
  bool isSequence() const { return m_node.IsSequence(); }
  bool isMap() const { return m_node.IsMap(); }
  const std::string& field() const { return m_field; }

  /// A name, not empty.
  std::string text() const;
  /// A whole token, finite, from low to high.
  double number(double low = -kAny, double high = kAny) const;
  int integer(int low, int high) const;
  bool boolean() const;
  /// Whether the whole token is a number.
  bool isNumber() const;
  std::vector<YamlValue> items() const;
  std::vector<double> numbers(double low = -kAny, double high = kAny) const;
  Vector3 vector() const;

  static constexpr double kAny = std::numeric_limits<double>::max();

 protected:
  std::string scalarText() const { return m_node.IsScalar() ? m_node.Scalar() : std::string(); }

  YAML::Node m_node;
  std::string m_where;
  std::string m_field;
};

/// A map of a scene file. Unknown and doubled keys are refused.
class YamlSection : public YamlValue {
 public:
  YamlSection(const YamlValue& value, std::initializer_list<const char*> keys);

  std::optional<YamlValue> find(const std::string& key) const;
  YamlValue require(const std::string& key, const std::string& remedy) const;
  /// Keys in the order of the file.
  const std::vector<std::string>& keys() const { return m_keys; }

 private:
  std::vector<std::string> m_keys;
};

/// Parses one YAML document. @throws spectral::InputError with line and column
YamlValue parseYaml(const std::string& text, const std::string& where);

}  // namespace metamer::spectral_ref
