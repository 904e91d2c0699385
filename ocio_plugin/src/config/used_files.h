// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "config/config_document.h"

namespace metamer::ocio {

/// The files that a config reads and that stay as they are when looks are added to it: what transforms name, through
/// every folder of the search path, and what those files refer to in turn.
class UsedFiles {
 public:
  /// @param folders   that relative names start from
  /// @param replaced  lower-case names of looks and named transforms that are made anew: theirs alone may change
  UsedFiles(const ConfigFacts& facts, const std::vector<std::filesystem::path>& folders,
            const std::set<std::string>& replaced);

  /// A file more that is to stay, such as a certificate.
  void add(const std::filesystem::path& file, const std::string& user);

  /// Names whatever reads the file as "is read by look or named transform 'NAME'" or "is read by the config"; empty
  /// where nothing does.
  std::string userOf(const std::filesystem::path& file) const;

  /// @throws spectral::InputError where the config reads the file. @param remedy  what to do about it
  void refuse(const std::filesystem::path& file, const std::string& remedy) const;

 private:
  struct Use {
    std::string pattern;  ///< absolute; kAnything stands for the value of a variable that nobody knows
    std::string user;
  };
  void addWithReferences(const std::string& path, const std::string& user);

  std::vector<Use> m_uses;
};

}  // namespace metamer::ocio
