// SPDX-License-Identifier: Apache-2.0
#include "metamer/spectral/yaml_tree.h"

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <optional>
#include <sstream>
#include <utility>

#include "metamer/spectral/input_error.h"
#include "metamer/spectral/text.h"
#include "yaml/number_lists.h"

namespace metamer::spectral {
namespace {

bool isControl(char c) {
  const auto byte = static_cast<unsigned char>(c);
  return byte < 0x20 || byte == 0x7F;
}

std::string placeOf(const std::string& where, const YAML::Mark& mark, const YamlForm& form) {
  const std::string line = where + ":" + std::to_string(std::max(mark.line, 0) + 1);
  return form.saysColumns ? line + ":" + std::to_string(std::max(mark.column, 0) + 1) : line;
}

/// What a shortened text makes of a document cannot be trusted.
struct NotAsShortened {};

/// Builds the tree from the parser's events, which come in the order of the text: what is refused is refused before
/// anything after it is read.
class TreeBuilder : public YAML::EventHandler {
 public:
  /// @param shortened  what the parser reads, where that is not the document itself
  TreeBuilder(const std::string& where, const YamlForm& form, const ShortenedText* shortened)
      : m_where(where), m_form(form), m_shortened(shortened) {}

  YamlNode root() && {
    if (m_shortened != nullptr && m_listCount != m_shortened->lists.size()) {
      throw NotAsShortened();
    }
    return std::move(m_root);
  }

  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override { add(mark, "", anchor, YamlNode::Kind::Null); }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override {
    throw error(mark, "alias", "", "aliases are not allowed in a " + m_form.name + "; write the value out");
  }
  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override {
    const bool isValue = m_open.empty() || m_open.back()->kind != YamlNode::Kind::Map || m_hasKey;
    if (m_shortened != nullptr && ShortenedText::isMarked(value)) {
      const NumberList* const list = m_shortened->find(value);
      if (list == nullptr || !isValue || tag != "?") {
        throw NotAsShortened();
      }
      addList(mark, anchor, *list);
      return;
    }
    if (std::any_of(value.begin(), value.end(), isControl)) {
      throw error(mark, "value", value, "control characters are not allowed");
    }
    if (!isUtf8(value)) {  // yaml-cpp makes half a character of these two
      throw error(mark, "value", "", "the escapes \\N and \\_ cannot be read; write the character itself");
    }
    if (isValue) {
      YamlNode& node = add(mark, tag, anchor, YamlNode::Kind::Scalar);
      node.text = value;
      node.quoted = tag == "!";
      return;
    }
    check(mark, tag, anchor);
    m_key = {value, {}, mark.line + 1, columnOf(mark) + 1};
    m_hasKey = true;
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    open(mark, tag, anchor, YamlNode::Kind::Sequence);
  }
  void OnSequenceEnd() override { m_open.pop_back(); }
  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    open(mark, tag, anchor, YamlNode::Kind::Map);
  }
  void OnMapEnd() override { m_open.pop_back(); }

 private:
  /// In the document.
  int columnOf(const YAML::Mark& mark) const { return mark.column + (mark.line == m_shiftedLine ? m_shift : 0); }

  /// What the parser would have told of the list itself.
  void addList(const YAML::Mark& mark, YAML::anchor_t anchor, const NumberList& list) {
    open(mark, "?", anchor, YamlNode::Kind::Sequence);
    m_shiftedLine = -1;
    m_open.back()->items.reserve(list.numbers.size());
    for (const NumberList::Number& number : list.numbers) {
      YAML::Mark at = mark;
      at.line = number.line;
      at.column = number.column;
      add(at, "?", 0, YamlNode::Kind::Scalar).text = number.text;
    }
    m_open.pop_back();
    m_shiftedLine = list.lastLine;
    m_shift = list.shift;
    ++m_listCount;
  }

  InputError error(const YAML::Mark& mark, const std::string& field, const std::string& value,
                   const std::string& remedy) const {
    return InputError(placeOf(m_where, mark, m_form), field, value, remedy);
  }

  void check(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor) {
    if (anchor != 0) {
      throw error(mark, "anchor", "", "anchors are not allowed in a " + m_form.name + "; write the value out");
    }
    if (!tag.empty() && tag != "?" && tag != "!") {
      throw error(mark, "tag", tag, "tags are not allowed in a " + m_form.name + "; leave it out");
    }
    if (++m_count > m_form.mostNodes) {
      throw error(mark, "", "", "more than " + std::to_string(m_form.mostNodes) + " values; this is no " + m_form.name);
    }
  }

  YamlNode& add(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor, YamlNode::Kind kind) {
    check(mark, tag, anchor);
    YamlNode node;
    node.kind = kind;
    node.line = mark.line + 1;
    node.column = columnOf(mark) + 1;
    if (m_open.empty()) {
      m_root = std::move(node);
      return m_root;
    }
    YamlNode& parent = *m_open.back();
    if (parent.kind == YamlNode::Kind::Sequence) {
      return parent.items.emplace_back(std::move(node));
    }
    if (!m_hasKey) {
      throw error(mark, "key", "", "a key must be a plain word");
    }
    m_hasKey = false;
    m_key.value = std::move(node);
    return parent.members.emplace_back(std::move(m_key)).value;
  }

  void open(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor, YamlNode::Kind kind) {
    if (m_open.size() >= static_cast<std::size_t>(m_form.deepest)) {
      throw error(mark, "", "",
                  "nested deeper than " + std::to_string(m_form.deepest) + " levels; this is no " + m_form.name);
    }
    // The parents' children do not move while one of them is open: it is always the last.
    m_open.push_back(&add(mark, tag, anchor, kind));
  }

  const std::string& m_where;
  const YamlForm& m_form;
  YamlNode m_root;
  std::vector<YamlNode*> m_open;
  YamlMember m_key;
  bool m_hasKey = false;
  int m_count = 0;
  const ShortenedText* m_shortened;
  std::size_t m_listCount = 0;
  int m_shiftedLine = -1;  ///< where columns of the shortened text are not the document's
  int m_shift = 0;
};

/// @param text  the document, or what it is shortened to
YamlNode parsed(const std::string& text, const std::string& where, const YamlForm& form,
                const ShortenedText* shortened) {
  std::istringstream stream(text);
  YAML::Parser parser(stream);
  TreeBuilder builder(where, form, shortened);
  if (!parser.HandleNextDocument(builder)) {
    throw InputError(where, form.name, "", "is empty; " + form.beginning());
  }
  YamlNode root = std::move(builder).root();
  TreeBuilder second(where, form, nullptr);
  if (parser.HandleNextDocument(second)) {
    throw InputError(where, form.name, "", "holds more than one document; keep one " + form.name + " a file");
  }
  return root;
}

/// Nothing where the document has to be read as it stands.
std::optional<YamlNode> parsedWithoutNumberLists(const std::string& text, const std::string& where,
                                                 const YamlForm& form) {
  const std::optional<ShortenedText> shortened = withoutNumberLists(text);
  if (!shortened) {
    return std::nullopt;
  }
  try {
    return parsed(shortened->text, where, form, &*shortened);
  } catch (const NotAsShortened&) {
  } catch (const YAML::Exception&) {  // to be told with its place in the document
  } catch (const InputError&) {
  }
  return std::nullopt;
}

}  // namespace

std::string YamlNode::kindName() const {
  switch (kind) {
    case Kind::Null:
      return "nothing";
    case Kind::Scalar:
      return "value";
    case Kind::Sequence:
      return "list";
    case Kind::Map:
      return "map";
  }
  return {};
}

const YamlNode* YamlNode::find(const std::string& key) const {
  const auto member = std::find_if(members.begin(), members.end(), [&](const YamlMember& m) { return m.key == key; });
  return member != members.end() ? &member->value : nullptr;
}

YamlNode parseYaml(const std::string& text, const std::string& where, const YamlForm& form) {
  const std::string utf8(checkedUtf8(text, where));
  int line = 1;
  for (const char c : utf8) {
    line += c == '\n' ? 1 : 0;
    if (isControl(c) && c != '\n' && c != '\r' && c != '\t') {
      throw InputError(where + ":" + std::to_string(line), "text", "", "is not a text file (control characters)");
    }
  }
  if (auto root = parsedWithoutNumberLists(utf8, where, form)) {
    return std::move(*root);
  }
  try {
    return parsed(utf8, where, form, nullptr);
  } catch (const YAML::Exception& error) {
    throw InputError(placeOf(where, error.mark, form), "YAML", "", error.msg);
  }
}

}  // namespace metamer::spectral
