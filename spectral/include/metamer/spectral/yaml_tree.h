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
  std::string text;                 ///< of a scalar
  bool quoted = false;              ///< a scalar in quotes
  int line = 1;                     ///< from 1
  std::vector<YamlNode> items;      ///< of a sequence
  std::vector<YamlMember> members;  ///< of a map, in their order; keys may repeat

  std::string kindName() const;
};

struct YamlMember {
  std::string key;
  YamlNode value;
};

/// Parses one document. Aliases, anchors, tags, a second document, control characters, more than kDeepestYaml levels
/// and more than kMostYamlNodes nodes are refused: a recipe needs none of them, and with them a small file can be an
/// endless one.
/// @param document  what messages call the whole: "recipe", "stage"
/// @throws spectral::InputError with the line
YamlNode parseYaml(const std::string& text, const std::string& where, const std::string& document = "recipe");

inline constexpr int kDeepestYaml = 16;
inline constexpr int kMostYamlNodes = 10000;

}  // namespace metamer::spectral
