// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <initializer_list>
#include <string>

#include "metamer/spectral/input_error.h"
#include "metamer/spectral/yaml_tree.h"

namespace metamer::spectral {

/// A map of a YAML document, read key by key. Unknown and repeated keys are refused.
class YamlSection {
 public:
  /// @param where     what messages call the file
  /// @param path      dotted name of the section for messages; empty at the top
  /// @param document  what messages call the whole: "recipe", "stage"
  YamlSection(const YamlNode& node, std::string where, std::string path, std::initializer_list<const char*> keys,
              const std::string& document = "recipe");

  /// Null where the key is not there.
  const YamlNode* find(const std::string& key) const;
  const YamlNode& require(const std::string& key, const std::string& remedy) const;

  /// A scalar's text, not empty.
  std::string text(const YamlNode& node, const std::string& key) const;
  /// A whole token as a number within low ... high.
  double number(const YamlNode& node, const std::string& key, double low, double high) const;

  /// Each leaves `target` alone where the key is not there.
  void read(const std::string& key, std::string& target) const;
  void read(const std::string& key, double& target, double low, double high) const;
  void read(const std::string& key, bool& target) const;

  std::string named(const std::string& key) const { return m_path.empty() ? key : m_path + "." + key; }
  InputError error(const YamlNode& node, const std::string& field, const std::string& value,
                   const std::string& remedy) const;
  const std::string& where() const { return m_where; }
  const YamlNode& node() const { return m_node; }

 private:
  const YamlNode& m_node;
  std::string m_where;
  std::string m_path;
};

}  // namespace metamer::spectral
