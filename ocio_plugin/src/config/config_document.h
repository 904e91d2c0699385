// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace metamer::ocio {

/// A file that a transform of a config reads.
struct ConfigFile {
  std::string src;   ///< as written
  std::string user;  ///< lower-case name of the look or named transform; empty for anything else
};

/// What must be known of an OCIO config to add to it, read from its YAML: of any profile version, whatever release of
/// OCIO is at hand.
struct ConfigFacts {
  int majorVersion = 0;
  int minorVersion = 0;
  char familySeparator = '/';
  std::vector<std::string> searchPath;
  std::map<std::string, std::string> roles;        ///< lower-case role to colour space
  std::map<std::string, std::string> spaces;       ///< lower-case name or alias of a colour space to its name
  std::set<std::string> dataSpaces;                ///< names
  std::vector<std::string> spaceNames;             ///< in their order
  std::set<std::string> taken;                     ///< lower-case: names, aliases and roles no transform may have
  std::set<std::string> looks;                     ///< lower-case
  std::set<std::string> namedTransforms;           ///< lower-case names
  std::vector<std::string> files;                  ///< what its transforms read, as written, each once
  std::vector<ConfigFile> fileUses;                ///< the same, each with what reads it
  std::map<std::string, std::string> environment;  ///< defaults of variables

  /// Name of a colour space by its name, alias or role, without regard to case.
  std::optional<std::string> space(const std::string& name) const;
};

/// A config's YAML, which can be added to without another byte of it changing.
class ConfigDocument {
 public:
  /// @param where  what messages call it
  /// @throws spectral::InputError: no YAML, not a config, parts that are of the wrong kind
  ConfigDocument(std::string text, std::string where);

  const ConfigFacts& facts() const { return m_facts; }

  const std::string& text() const { return m_text; }

  /// The text with looks, named transforms, colour spaces and a folder at the end of the search path added. Everything
  /// else is there byte for byte, and the result is checked to be the same document but for them.
  /// @param looks, namedTransforms, colourSpaces  YAML block sequences ("- !<Look>\n  name: ..."), empty for none
  /// @param searchFolder                          empty: the search path stays
  /// @param replaces  whether an item takes the place of one of its list that has its name, letter case aside
  /// @throws spectral::InputError where the text is written in a way that cannot be added to
  std::string with(const std::string& looks, const std::string& namedTransforms, const std::string& searchFolder,
                   const std::string& colourSpaces = {}, bool replaces = false) const;

 private:
  std::string m_text;
  std::string m_where;
  ConfigFacts m_facts;
};

}  // namespace metamer::ocio
