// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <initializer_list>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "metamer/spectral/input_error.h"
#include "metamer/spectral/yaml_tree.h"

namespace metamer::spectral {

/// One value of a YAML document, read with checks; every complaint names the file, the line and the field.
class YamlValue {
 public:
  static constexpr double kAny = std::numeric_limits<double>::max();

  /// Parses a document, which all values of it share. @throws InputError as parseYaml
  static YamlValue parse(const std::string& text, const std::string& where, const YamlForm& form = {});
  /// As if a file had said it.
  static YamlValue ofText(const std::string& text, const std::string& field);

  InputError error(const std::string& value, const std::string& remedy) const;
  InputError error(const std::string& remedy) const { return error(m_node->text, remedy); }

  bool isNull() const { return m_node->kind == YamlNode::Kind::Null; }
  bool isScalar() const { return m_node->kind == YamlNode::Kind::Scalar; }
  bool isSequence() const { return m_node->kind == YamlNode::Kind::Sequence; }
  bool isMap() const { return m_node->kind == YamlNode::Kind::Map; }
  /// Whether it is this token, without quotes.
  bool is(const std::string& token) const { return isScalar() && !m_node->quoted && m_node->text == token; }
  /// Whether the whole token is a number, without quotes.
  bool isNumber() const;
  /// Dotted name, empty at the top.
  const std::string& field() const { return m_field; }

  /// Of a list, else 0.
  std::size_t size() const { return m_node->items.size(); }
  /// A name, not empty.
  std::string text() const;
  /// A whole token without quotes, finite, from low to high.
  double number(double low = -kAny, double high = kAny) const;
  int integer(int low, int high) const;
  bool boolean() const;
  std::vector<YamlValue> items() const;
  std::vector<double> numbers(double low = -kAny, double high = kAny) const;

 protected:
  struct Document {
    YamlNode root;
    std::string where;
    YamlForm form;
  };

  YamlValue(std::shared_ptr<const Document> document, const YamlNode& node, std::string field);
  /// A part of this value as a value of its own.
  YamlValue part(const YamlNode& node, std::string field) const { return {m_document, node, std::move(field)}; }
  std::string place(int line, int column) const;

  std::shared_ptr<const Document> m_document;
  const YamlNode* m_node;  // within the document
  std::string m_field;
};

/// A map of a YAML document. Unknown and doubled keys are refused.
class YamlMap : public YamlValue {
 public:
  /// @param keys  those that it may have; none: any
  YamlMap(const YamlValue& value, std::initializer_list<const char*> keys);

  std::optional<YamlValue> find(const std::string& key) const;
  YamlValue require(const std::string& key, const std::string& remedy) const;
  /// In the order of the file.
  std::vector<std::string> keys() const;
  /// Of a document's top: refuses one without its version, and every version but 1.
  void requireVersion() const;

  /// Each leaves `target` alone where the key is not there.
  void read(const std::string& key, std::string& target) const;
  void read(const std::string& key, double& target, double low, double high) const;
  void read(const std::string& key, bool& target) const;

 private:
  std::string named(const std::string& key) const { return m_field.empty() ? key : m_field + "." + key; }
};

}  // namespace metamer::spectral
