// SPDX-License-Identifier: Apache-2.0
#include "config/config_document.h"

#include <algorithm>

#include "config/config_facts.h"
#include "metamer/spectral/input_error.h"
#include "metamer/spectral/text.h"

namespace metamer::ocio {
namespace {

using spectral::InputError;

std::string nameOf(const YAML::Node& item) {
  const YAML::Node name = item.IsMap() ? item["name"] : YAML::Node();
  return name && name.IsScalar() ? spectral::lowerCase(name.Scalar()) : std::string();
}

/// With their line ends.
std::vector<std::string> splitLines(const std::string& text) {
  std::vector<std::string> lines;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size() - 1);
    lines.push_back(text.substr(begin, end + 1 - begin));
    begin = end + 1;
  }
  return lines;
}

bool isBlank(const std::string& line) {
  return line.find_first_not_of(" \t\r\n") == std::string::npos;
}

/// A block sequence that begins in column 0, an item each.
std::vector<std::string> splitItems(const std::string& items) {
  std::vector<std::string> result;
  for (const std::string& line : splitLines(items)) {
    if (line.rfind("- ", 0) == 0) {
      result.emplace_back();
    }
    if (!result.empty()) {
      result.back() += line;
    }
  }
  for (std::string& item : result) {
    item.erase(item.find_last_not_of('\n') + 1);
    item += '\n';
  }
  return result;
}

void setFlowStyle(YAML::Node node) {
  if (node.IsScalar() || node.IsNull()) {
    return;
  }
  node.SetStyle(YAML::EmitterStyle::Flow);
  for (auto member : node) {
    setFlowStyle(node.IsMap() ? YAML::Node(member.second) : YAML::Node(member));
  }
}

/// An item of a block sequence as it stands between brackets, on one line.
std::string inBrackets(const std::string& item) {
  const YAML::Node node = YAML::Load(item)[0];
  setFlowStyle(node);
  YAML::Emitter yaml;
  yaml << node;
  return yaml.c_str();
}

/// Where an item of a list stands that has the name of a new one; nothing for the others.
std::optional<std::size_t> placeOfName(const YAML::Node& list, const YAML::Node& item) {
  for (std::size_t k = 0; list && list.IsSequence() && k < list.size(); ++k) {
    if (!nameOf(item).empty() && nameOf(list[k]) == nameOf(item)) {
      return k;
    }
  }
  return std::nullopt;
}

/// Changes lines of a config. Its parts are where the parser says they are, in lines of the text as it came.
class Editor {
 public:
  Editor(const std::string& text, std::string where, const YAML::Node& root)
      : m_where(std::move(where)), m_lines(splitLines(text)), m_root(root) {
    m_lineEnd = text.find("\r\n") != std::string::npos ? "\r\n" : "\n";
    if (root.Style() == YAML::EmitterStyle::Flow) {
      throw InputError(m_where, "config", "", "is written in braces; write it as OCIO does, a key a line");
    }
    for (const auto& member : root) {
      m_keys.emplace_back(member.first.Scalar(), static_cast<std::size_t>(member.first.Mark().line));
      m_indent = static_cast<std::size_t>(member.first.Mark().column);
    }
  }

  /// Puts the items of a block sequence in the place of those that have their names.
  /// @return the others
  std::string replaceItems(const std::string& key, const std::string& items) {
    const YAML::Node list = m_root[key];
    std::string others;
    for (const std::string& text : splitItems(items)) {
      const auto place = placeOfName(list, YAML::Load(text)[0]);
      if (!place) {
        others += (others.empty() ? "" : "\n") + text;
        continue;
      }
      const std::size_t line = lineOf(key);
      if (list.Style() == YAML::EmitterStyle::Flow) {
        throw InputError(placeOf(line), key, "", "is no list with an item a line; write it as OCIO does");
      }
      const std::size_t column = dashColumn(list, line, key);
      const std::size_t begin = dashLine(list[*place], line, column);
      const std::size_t next = *place + 1 < list.size() ? dashLine(list[*place + 1], line, column) : sectionEnd(line);
      m_replaced[begin] = behindItem(begin, next, column);
      insert(begin, "", text, column);
    }
    return others;
  }

  /// Adds a block sequence to that of a key, at its end; with the key, at the document's end, where it has none.
  void addItems(const std::string& key, const std::string& items) {
    if (items.empty()) {
      return;
    }
    const YAML::Node value = m_root[key];
    if (!value) {
      insert(behindContent(documentEnd()), "\n" + std::string(m_indent, ' ') + key + ":\n", items, m_indent + 2);
      return;
    }
    const std::size_t line = lineOf(key);
    if (value.IsNull() || (value.IsSequence() && value.size() == 0)) {
      clearValue(line, key);
      insert(line + 1, "", items, m_indent + 2);
    } else if (value.IsSequence() && value.Style() != YAML::EmitterStyle::Flow) {
      insert(sectionEnd(line), "\n", items, dashColumn(value, line, key));
    } else if (value.IsSequence()) {
      addInBrackets(line, key, items);
    } else {
      throw InputError(placeOf(line), key, "", "is no list with an item a line; write it as OCIO does");
    }
  }

  void addSearchFolder(const std::string& folder) {
    const YAML::Node value = m_root["search_path"];
    if (!value) {
      insert(lineOf("ocio_profile_version") + 1, "", "search_path: " + folder + "\n", m_indent);
      return;
    }
    const std::size_t line = lineOf("search_path");
    if (value.IsSequence() && value.size() > 0 && value.Style() != YAML::EmitterStyle::Flow) {
      insert(sectionEnd(line), "", "- " + folder + "\n", dashColumn(value, line, "search_path"));
      return;
    }
    const bool isEmpty = value.IsScalar() ? value.Scalar().empty() : value.size() == 0;
    if (isEmpty) {
      clearValue(line, "search_path");
      m_lines[line].insert(m_lines[line].find(':') + 1, " " + folder);
      return;
    }
    std::string& text = m_lines[line];
    const std::size_t begin = text.find_first_not_of(" \t", text.find(':') + 1);
    if (value.IsScalar() && static_cast<std::size_t>(value.Mark().line) == line && begin != std::string::npos) {
      const bool isQuoted = text[begin] == '"' || text[begin] == '\'';
      const std::size_t plainEnd = text.find_last_not_of(" \t\r\n", std::min(text.find(" #", begin), text.size()) - 1);
      const std::size_t end = isQuoted ? text.find(text[begin], begin + 1) : plainEnd + 1;
      if (end != std::string::npos) {
        text.insert(end, ":" + folder);
        return;
      }
    }
    throw InputError(placeOf(line), "search_path", "",
                     "is written in a way that cannot be added to; write it on one line");
  }

  std::string text() const {
    std::string all;
    std::size_t kept = 0;
    for (std::size_t line = 0; line <= m_lines.size(); ++line) {
      if (const auto found = m_insertions.find(line); found != m_insertions.end()) {
        all += !all.empty() && all.back() != '\n' ? m_lineEnd + found->second : found->second;
      }
      if (const auto found = m_replaced.find(line); found != m_replaced.end()) {
        kept = found->second;
      }
      if (line < m_lines.size() && line >= kept) {
        all += m_lines[line];
      }
    }
    return all;
  }

 private:
  /// Adds items before the bracket that ends a list.
  void addInBrackets(std::size_t keyLine, const std::string& key, const std::string& items) {
    for (std::size_t line = sectionEnd(keyLine); line-- > keyLine;) {
      std::string& text = m_lines[line];
      const std::size_t bracket = text.rfind(']', std::min(text.find(" #"), text.size()));
      if (bracket != std::string::npos) {
        std::string added;
        for (const std::string& item : splitItems(items)) {
          added += ", " + inBrackets(item);
        }
        text.insert(bracket, added);
        return;
      }
    }
    throw InputError(placeOf(keyLine), key, "", "is no list with an item a line; write it as OCIO does");
  }

  std::string placeOf(std::size_t line) const { return m_where + ":" + std::to_string(line + 1); }

  std::size_t lineOf(const std::string& key) const {
    const auto found =
        std::find_if(m_keys.begin(), m_keys.end(), [&](const auto& entry) { return entry.first == key; });
    return found->second;
  }

  /// First line behind a key's value, short of blank lines and comments that stand before the next key.
  std::size_t sectionEnd(std::size_t keyLine) const {
    std::size_t end = documentEnd();
    for (const auto& [key, line] : m_keys) {
      end = line > keyLine ? std::min(end, line) : end;
    }
    return behindContent(end);
  }

  std::size_t documentEnd() const {
    std::size_t line = m_keys.back().second + 1;
    while (line < m_lines.size() && m_lines[line].rfind("...", 0) != 0 && m_lines[line].rfind("---", 0) != 0) {
      ++line;
    }
    return line;
  }

  /// A comment less indented than any value belongs to what follows; one further in may be part of a text.
  std::size_t behindContent(std::size_t end) const {
    const auto isBetween = [&](const std::string& line) {
      return isBlank(line) || (line.find_first_not_of(' ') == m_indent && line[m_indent] == '#');
    };
    while (end > 0 && isBetween(m_lines[end - 1])) {
      --end;
    }
    return end;
  }

  /// First line behind an item, short of what stands between it and the next.
  std::size_t behindItem(std::size_t begin, std::size_t next, std::size_t column) const {
    const auto isBetween = [&](const std::string& line) {
      const std::size_t first = line.find_first_not_of(' ');
      return isBlank(line) || (first <= column && line[first] == '#');
    };
    while (next > begin + 1 && isBetween(m_lines[next - 1])) {
      --next;
    }
    return next;
  }

  /// The line of an item's dash: the parser marks its tag or its first key.
  std::size_t dashLine(const YAML::Node& item, std::size_t keyLine, std::size_t column) const {
    auto line = static_cast<std::size_t>(item.Mark().line);
    while (line > keyLine + 1 && !(m_lines[line].find_first_not_of(' ') == column && m_lines[line][column] == '-')) {
      --line;
    }
    return line;
  }

  std::size_t dashColumn(const YAML::Node& sequence, std::size_t keyLine, const std::string& key) const {
    // The parser marks an item's tag or its first key: its dash is there or above.
    for (auto line = static_cast<std::size_t>(sequence.begin()->Mark().line); line > keyLine; --line) {
      const std::size_t column = m_lines[line].find_first_not_of(' ');
      if (column != std::string::npos && m_lines[line][column] == '-') {
        return column;
      }
    }
    throw InputError(placeOf(keyLine), key, "", "is no list with an item a line; write it as OCIO does");
  }

  /// Takes an empty value ("", "[]", "~") off a key's line.
  void clearValue(std::size_t line, const std::string& key) {
    std::string& text = m_lines[line];
    const std::size_t begin = text.find(':', m_indent + key.size()) + 1;
    const std::size_t end = std::min(text.find('#', begin), text.find_last_not_of("\r\n") + 1);
    if (text.substr(begin, end - begin).find_first_not_of(" \t[]~nul\"'") != std::string::npos) {
      throw InputError(placeOf(line), key, "", "is written in a way that cannot be added to; write it as OCIO does");
    }
    text.replace(begin, end - begin, text[end] == '#' ? " " : "");
  }

  /// @param line  of the text as it came: the block goes before it, behind what was put there earlier
  void insert(std::size_t line, const std::string& heading, const std::string& block, std::size_t columns) {
    std::string added = heading;
    for (const std::string& text : splitLines(block)) {
      added += isBlank(text) ? "\n" : std::string(columns, ' ') + text;
    }
    std::string& all = m_insertions[line];
    for (const char c : added) {
      all += c == '\n' ? m_lineEnd : std::string(1, c);
    }
  }

  std::string m_where;
  std::vector<std::string> m_lines;
  YAML::Node m_root;
  std::string m_lineEnd;
  std::size_t m_indent = 0;
  std::vector<std::pair<std::string, std::size_t>> m_keys;
  std::map<std::size_t, std::string> m_insertions;
  std::map<std::size_t, std::size_t> m_replaced;  ///< first line of what gives way to the line behind it
};

/// Whether `after` is the list `before` with the items of a block sequence at its end, those whose names it had in
/// their places where they replace. Nothing counts as an empty list.
bool isExtended(const YAML::Node& before, const YAML::Node& after, const YAML::Node& items, bool replaces) {
  std::vector<YAML::Node> expected;
  for (std::size_t k = 0; before && before.IsSequence() && k < before.size(); ++k) {
    expected.push_back(before[k]);
  }
  for (std::size_t k = 0; k < items.size(); ++k) {
    const YAML::Node item = items[k];
    const auto place = replaces ? placeOfName(before, item) : std::nullopt;
    if (place) {
      expected[*place].reset(item);  // an assignment would change the document
    } else {
      expected.push_back(item);
    }
  }
  bool isSame = after && after.IsSequence() && after.size() == expected.size();
  for (std::size_t k = 0; isSame && k < expected.size(); ++k) {
    isSame = isSameYaml(expected[k], after[k]);
  }
  return isSame;
}

/// Whether a document is another but for what was added to it.
bool isExtension(const YAML::Node& before, const YAML::Node& after, const std::map<std::string, YAML::Node>& added,
                 const std::string& searchFolder, bool replaces) {
  std::size_t newKeys = !searchFolder.empty() && !before["search_path"] ? 1 : 0;
  auto folders = searchPathOf(before["search_path"]);
  if (!searchFolder.empty()) {
    folders.push_back(searchFolder);
  }
  if (folders != searchPathOf(after["search_path"])) {
    return false;
  }
  for (const auto& [key, items] : added) {
    newKeys += items.size() > 0 && !before[key] ? 1 : 0;
    if (items.size() > 0 && !isExtended(before[key], after[key], items, replaces)) {
      return false;
    }
  }
  if (after.size() != before.size() + newKeys) {
    return false;
  }
  for (const auto& member : before) {
    const std::string key = member.first.Scalar();
    const auto found = added.find(key);
    const bool isAddedTo = key == "search_path" || (found != added.end() && found->second.size() > 0);
    if (!isAddedTo && !isSameYaml(member.second, after[key])) {
      return false;
    }
  }
  return true;
}

}  // namespace

ConfigDocument::ConfigDocument(std::string text, std::string where)
    : m_text(std::move(text)),
      m_where(std::move(where)),
      m_facts(readConfigFacts(parseConfigYaml(m_text, m_where), m_where)) {}

std::string ConfigDocument::with(const std::string& looks, const std::string& namedTransforms,
                                 const std::string& searchFolder, const std::string& colourSpaces,
                                 bool replaces) const {
  const YAML::Node before = parseConfigYaml(m_text, m_where);
  Editor editor(m_text, m_where, before);
  std::map<std::string, std::string> lists = {
      {"colorspaces", colourSpaces}, {"looks", looks}, {"named_transforms", namedTransforms}};
  const std::map<std::string, YAML::Node> added = {{"colorspaces", YAML::Load(colourSpaces)},
                                                   {"looks", YAML::Load(looks)},
                                                   {"named_transforms", YAML::Load(namedTransforms)}};
  if (replaces) {
    for (auto& [key, items] : lists) {
      items = editor.replaceItems(key, items);
    }
  }
  // First the lists that are there: items of the document's last one go before keys that are new behind it.
  for (const bool isThere : {true, false}) {
    for (const auto& [key, items] : lists) {
      if (static_cast<bool>(before[key]) == isThere) {
        editor.addItems(key, items);
      }
    }
  }
  if (!searchFolder.empty()) {
    editor.addSearchFolder(searchFolder);
  }
  std::string result = editor.text();
  if (!isExtension(before, parseConfigYaml(result, m_where), added, searchFolder, replaces)) {
    throw InputError(
        m_where, "config", "",
        "is written in a way that cannot be added to without changing it; load and save it with OCIO once");
  }
  return result;
}

}  // namespace metamer::ocio
