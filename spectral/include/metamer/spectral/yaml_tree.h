// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace metamer::spectral {

struct YamlMember;

/// A YAML document of plain scalars, lists and maps, with the lines its parts stand on.
struct YamlNode {
  enum class Kind { Null, Scalar, Sequence, Map };
  Kind kind = Kind::Null;
  std::string text;     ///< of a scalar
  bool quoted = false;  ///< a scalar in quotes
  int line = 1;         ///< from 1, as columns
  int column = 1;
  std::vector<YamlNode> items;      ///< of a sequence
  std::vector<YamlMember> members;  ///< of a map, in their order; keys may repeat

  std::string kindName() const;
  /// The first value of a key of a map, null where there is none.
  const YamlNode* find(const std::string& key) const;
};

struct YamlMember {
  std::string key;
  YamlNode value;
  int line = 1;  ///< of the key
  int column = 1;
};

/// What a document may be and what messages call it.
struct YamlForm {
  std::string name = "recipe";  ///< "recipe", "stage", "scene"
  int deepest = 16;             ///< levels
  int mostNodes = 10000;
  bool saysColumns = false;  ///< whether messages name the column beside the line

  /// The key that a document starts with: "metamer", "metamer_stage".
  std::string versionKey() const { return name == "recipe" ? "metamer" : "metamer_" + name; }
  /// "a stage starts with 'metamer_stage: 1'".
  std::string beginning() const { return "a " + name + " starts with '" + versionKey() + ": 1'"; }
};

/// Parses one document. Aliases, anchors, tags, a second document, control characters, more levels or nodes than the
/// form allows are refused: nothing here needs them, and with them a small file can be an endless one.
/// @throws spectral::InputError with the line
YamlNode parseYaml(const std::string& text, const std::string& where, const YamlForm& form = {});

}  // namespace metamer::spectral
