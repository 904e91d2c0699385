// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <utility>

#include "metamer/spectral/data_library.h"

namespace metamer::spectral {

/// What the names of data/ are, in words.
class DataWords {
 public:
  void add(const std::string& group, const std::string& name, NameDescription description);

  /// Empty where nothing is known.
  NameDescription of(const std::string& group, const std::string& name) const;

  /// Whether each word of a text stands in the name, its description or its words.
  bool isFound(const std::string& group, const std::string& name, const std::string& text) const;

  /// The same of whole words, the name itself aside: whether people call it that.
  bool isWordFor(const std::string& group, const std::string& name, const std::string& text) const;

 private:
  std::map<std::pair<std::string, std::string>, NameDescription> m_descriptions;  ///< names in lower case
};

/// Reads words.json; a folder without it has no words.
/// @throws InputError where it is malformed
DataWords readWords(const std::filesystem::path& folder);

}  // namespace metamer::spectral
