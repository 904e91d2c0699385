// SPDX-License-Identifier: Apache-2.0
#include "files/data_words.h"

#include <algorithm>
#include <system_error>

#include "files/json_text.h"
#include "metamer/spectral/input_error.h"
#include "metamer/spectral/path_text.h"
#include "metamer/spectral/spectral_files.h"
#include "metamer/spectral/text.h"

namespace metamer::spectral {
namespace {

std::vector<std::string> texts(const nlohmann::json& list, const std::string& where, const std::string& field) {
  std::vector<std::string> result;
  if (!list.is_array()) {
    throw InputError(where, field, valueText(list), "must be a list");
  }
  for (const nlohmann::json& item : list) {
    if (!item.is_string()) {
      throw InputError(where, field, valueText(item), "must be text in quotes");
    }
    result.push_back(item.get<std::string>());
  }
  return result;
}

/// Description and words in lower case, a space round each.
std::string allWords(const NameDescription& description) {
  std::string all = " " + lowerCase(description.text);
  for (const std::string& word : description.words) {
    all += " " + lowerCase(word);
  }
  for (char& c : all) {
    c = c == ',' || c == ':' || c == ';' ? ' ' : c;
  }
  return all + " ";
}

/// Whether each word of a text, as `form` makes it, is within `all`.
template <typename Form>
bool holdsEach(const std::string& all, const std::string& text, const Form& form) {
  const std::string wanted = lowerCase(trimmed(text));
  for (std::size_t begin = 0; begin < wanted.size();) {
    const std::size_t end = std::min(wanted.find(' ', begin), wanted.size());
    if (all.find(form(wanted.substr(begin, end - begin))) == std::string::npos) {
      return false;
    }
    begin = end + 1;
  }
  return !wanted.empty();
}

}  // namespace

void DataWords::add(const std::string& group, const std::string& name, NameDescription description) {
  m_descriptions[{group, lowerCase(name)}] = std::move(description);
}

NameDescription DataWords::of(const std::string& group, const std::string& name) const {
  const auto found = m_descriptions.find({group, lowerCase(trimmed(name))});
  return found == m_descriptions.end() ? NameDescription{} : found->second;
}

bool DataWords::isFound(const std::string& group, const std::string& name, const std::string& text) const {
  const std::string all = lowerCase(name) + allWords(of(group, name));
  return holdsEach(all, text, [](const std::string& word) { return word; });
}

bool DataWords::isWordFor(const std::string& group, const std::string& name, const std::string& text) const {
  const std::string all = allWords(of(group, name));
  return holdsEach(all, text, [](const std::string& word) { return " " + word + " "; });
}

DataWords readWords(const std::filesystem::path& folder) {
  DataWords words;
  const std::filesystem::path file = folder / "words.json";
  std::error_code none;
  if (!std::filesystem::exists(file, none)) {
    return words;
  }
  const std::string where = utf8(file);
  const nlohmann::json document = parseJson(readTextFile(file), where);
  const nlohmann::json& entries = member(document, "entries");
  if (!entries.is_array()) {
    throw InputError(where, "entries", "", "must be a list");
  }
  for (const nlohmann::json& entry : entries) {
    const std::string group = requiredText(entry, "group", where);
    const NameDescription description{requiredText(entry, "description", where),
                                      texts(member(entry, "words"), where, "words")};
    for (const std::string& name : texts(member(entry, "names"), where, "names")) {
      words.add(group, name, description);
    }
  }
  return words;
}

}  // namespace metamer::spectral
