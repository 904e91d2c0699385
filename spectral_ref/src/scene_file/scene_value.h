// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <initializer_list>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "metamer/spectral/input_error.h"
#include "metamer/spectral/yaml_tree.h"
#include "metamer/spectral_ref/scene.h"

namespace metamer::spectral_ref {

/// One value of a scene file, read with checks; every complaint names file, line and column.
class SceneValue {
 public:
  /// @param node  shares the document that it is part of
  SceneValue(std::shared_ptr<const spectral::YamlNode> node, std::string where, std::string field)
      : m_node(std::move(node)), m_where(std::move(where)), m_field(std::move(field)) {}
  /// As if a file had said it.
  static SceneValue ofText(const std::string& text, const std::string& field);

  spectral::InputError error(const std::string& value, const std::string& remedy) const;
  spectral::InputError error(const std::string& remedy) const { return error(scalarText(), remedy); }

  bool isScalar() const { return m_node->kind == Kind::Scalar; }
  bool isSequence() const { return m_node->kind == Kind::Sequence; }
  bool isMap() const { return m_node->kind == Kind::Map; }
  const std::string& field() const { return m_field; }

  /// A name, not empty.
  std::string text() const;
  /// A whole token, finite, from low to high.
  double number(double low = -kAny, double high = kAny) const;
  int integer(int low, int high) const;
  bool boolean() const;
  /// Whether the whole token is a number.
  bool isNumber() const;
  std::vector<SceneValue> items() const;
  std::vector<double> numbers(double low = -kAny, double high = kAny) const;
  Vector3 vector() const;

  static constexpr double kAny = std::numeric_limits<double>::max();

 protected:
  using Kind = spectral::YamlNode::Kind;

  const std::string& scalarText() const { return m_node->text; }
  std::string place(int line, int column) const;
  /// A part of this value as a value of its own.
  SceneValue part(const spectral::YamlNode& node, std::string field) const {
    return {std::shared_ptr<const spectral::YamlNode>(m_node, &node), m_where, std::move(field)};
  }

  std::shared_ptr<const spectral::YamlNode> m_node;
  std::string m_where;
  std::string m_field;
};

/// A map of a scene file. Unknown and doubled keys are refused.
class SceneSection : public SceneValue {
 public:
  SceneSection(const SceneValue& value, std::initializer_list<const char*> keys);

  std::optional<SceneValue> find(const std::string& key) const;
  SceneValue require(const std::string& key, const std::string& remedy) const;
  /// Keys in the order of the file.
  const std::vector<std::string>& keys() const { return m_keys; }

 private:
  std::vector<std::string> m_keys;
};

/// Parses a scene file's text. @throws spectral::InputError with line and column
SceneValue parseSceneText(const std::string& text, const std::string& where);

}  // namespace metamer::spectral_ref
