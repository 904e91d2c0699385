// SPDX-License-Identifier: Apache-2.0
#include "metamer/spectral/yaml_tree.h"

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <sstream>
#include <utility>

#include "metamer/spectral/input_error.h"
#include "metamer/spectral/text.h"

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

/// Builds the tree from the parser's events, which come in the order of the text: what is refused is refused before
/// anything after it is read.
class TreeBuilder : public YAML::EventHandler {
 public:
  TreeBuilder(const std::string& where, const YamlForm& form) : m_where(where), m_form(form) {}

  YamlNode root() && { return std::move(m_root); }

  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override { add(mark, "", anchor, YamlNode::Kind::Null); }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override {
    throw error(mark, "alias", "", "aliases are not allowed in a " + m_form.name + "; write the value out");
  }
  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override {
    if (std::any_of(value.begin(), value.end(), isControl)) {
      throw error(mark, "value", value, "control characters are not allowed");
    }
    if (!isUtf8(value)) {  // yaml-cpp makes half a character of these two
      throw error(mark, "value", "", "the escapes \\N and \\_ cannot be read; write the character itself");
    }
    if (m_open.empty() || m_open.back()->kind != YamlNode::Kind::Map || m_hasKey) {
      YamlNode& node = add(mark, tag, anchor, YamlNode::Kind::Scalar);
      node.text = value;
      node.quoted = tag == "!";
      return;
    }
    check(mark, tag, anchor);
    m_key = {value, {}, mark.line + 1, mark.column + 1};
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
    node.column = mark.column + 1;
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
};

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
  const std::string& document = form.name;
  const std::string utf8(checkedUtf8(text, where));
  int line = 1;
  for (const char c : utf8) {
    line += c == '\n' ? 1 : 0;
    if (isControl(c) && c != '\n' && c != '\r' && c != '\t') {
      throw InputError(where + ":" + std::to_string(line), "text", "", "is not a text file (control characters)");
    }
  }
  std::istringstream stream(utf8);
  TreeBuilder builder(where, form);
  try {
    YAML::Parser parser(stream);
    if (!parser.HandleNextDocument(builder)) {
      throw InputError(where, document, "", "is empty; " + form.beginning());
    }
    YamlNode root = std::move(builder).root();
    TreeBuilder second(where, form);
    if (parser.HandleNextDocument(second)) {
      throw InputError(where, document, "", "holds more than one document; keep one " + document + " a file");
    }
    return root;
  } catch (const YAML::Exception& error) {
    throw InputError(placeOf(where, error.mark, form), "YAML", "", error.msg);
  }
}

}  // namespace metamer::spectral
