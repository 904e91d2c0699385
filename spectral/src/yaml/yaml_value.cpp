// SPDX-License-Identifier: Apache-2.0
#include "metamer/spectral/yaml_value.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>
#include <string_view>
#include <system_error>
#include <utility>

#include "metamer/spectral/near_names.h"
#include "metamer/spectral/text.h"

namespace metamer::spectral {
namespace {

std::optional<double> finiteNumber(const YamlNode& node) {
  const std::string& text = node.text;
  const char* end = text.data() + text.size();
  const char* begin = text.data() + (!text.empty() && text.front() == '+' ? 1 : 0);
  double value = 0;
  const auto parsed = std::from_chars(begin, end, value);
  if (node.kind != YamlNode::Kind::Scalar || node.quoted || parsed.ec != std::errc() || parsed.ptr != end ||
      !std::isfinite(value)) {
    return std::nullopt;
  }
  return value;
}

/// From low to high, else nothing.
std::optional<double> numberWithin(const YamlNode& node, double low, double high) {
  const auto value = finiteNumber(node);
  return value && *value >= low && *value <= high ? value : std::nullopt;
}

std::string rangeText(double low, double high) {
  if (low == -YamlValue::kAny && high == YamlValue::kAny) {
    return "must be a finite number";
  }
  if (high == YamlValue::kAny) {
    return "must be a finite number, " + shortestNumber(low) + " or more";
  }
  return "must be a number from " + shortestNumber(low) + " to " + shortestNumber(high);
}

}  // namespace

YamlValue::YamlValue(std::shared_ptr<const Document> document, const YamlNode& node, std::string field)
    : m_document(std::move(document)), m_node(&node), m_field(std::move(field)) {}

YamlValue YamlValue::parse(const std::string& text, const std::string& where, const YamlForm& form) {
  auto document = std::make_shared<const Document>(Document{parseYaml(text, where, form), where, form});
  const YamlNode& root = document->root;
  return {std::move(document), root, ""};
}

YamlValue YamlValue::ofText(const std::string& text, const std::string& field) {
  Document said;
  said.root.kind = YamlNode::Kind::Scalar;
  said.root.text = text;
  auto document = std::make_shared<const Document>(std::move(said));
  const YamlNode& root = document->root;
  return {std::move(document), root, field};
}

std::string YamlValue::place(int line, int column) const {
  return m_document->where + ":" + std::to_string(line) +
         (m_document->form.saysColumns ? ":" + std::to_string(column) : std::string());
}

InputError YamlValue::error(const std::string& value, const std::string& remedy) const {
  return InputError(place(m_node->line, m_node->column), m_field.empty() ? m_document->form.name : m_field, value,
                    remedy);
}

bool YamlValue::isNumber() const {
  return finiteNumber(*m_node).has_value();
}

std::string YamlValue::text() const {
  if (isSequence() || isMap()) {
    throw error("must be a name, not a " + m_node->kindName());
  }
  if (m_node->text.empty()) {
    throw error("is empty; give a name or leave the key out");
  }
  return m_node->text;
}

double YamlValue::number(double low, double high) const {
  const auto value = numberWithin(*m_node, low, high);
  if (!value) {
    throw error(rangeText(low, high));
  }
  return *value;
}

int YamlValue::integer(int low, int high) const {
  const auto value = numberWithin(*m_node, low, high);
  if (!value || *value != std::floor(*value)) {
    throw error("must be a whole number from " + std::to_string(low) + " to " + std::to_string(high));
  }
  return static_cast<int>(*value);
}

bool YamlValue::boolean() const {
  if (!is("true") && !is("false")) {
    throw error("must be true or false");
  }
  return is("true");
}

std::vector<YamlValue> YamlValue::items() const {
  if (!isSequence()) {
    throw error("must be a list");
  }
  std::vector<YamlValue> result;
  for (std::size_t i = 0; i < m_node->items.size(); ++i) {
    result.push_back(part(m_node->items[i], m_field + "[" + std::to_string(i) + "]"));
  }
  return result;
}

std::vector<double> YamlValue::numbers(double low, double high) const {
  if (!isSequence()) {
    throw error("must be a list");
  }
  std::vector<double> result;
  result.reserve(m_node->items.size());
  for (std::size_t i = 0; i < m_node->items.size(); ++i) {
    const YamlNode& item = m_node->items[i];
    const auto value = numberWithin(item, low, high);
    if (!value) {
      throw part(item, m_field + "[" + std::to_string(i) + "]").error(rangeText(low, high));
    }
    result.push_back(*value);
  }
  return result;
}

YamlMap::YamlMap(const YamlValue& value, std::initializer_list<const char*> keys) : YamlValue(value) {
  const std::vector<std::string> known(keys.begin(), keys.end());
  if (!isMap()) {
    throw error("must be a map of " + joined(known) +
                (m_field.empty() ? ", such as '" + m_document->form.versionKey() + ": 1'" : std::string()));
  }
  std::set<std::string_view> seen;
  for (const YamlMember& member : m_node->members) {
    const auto complaint = [&](const std::string& remedy) {
      return InputError(place(member.line, member.column), "key", named(member.key), remedy);
    };
    if (member.key.empty()) {
      throw complaint("must be a name");
    }
    if (!known.empty() && std::find(known.begin(), known.end(), member.key) == known.end()) {
      const auto near = nearNames(member.key, known, 1);
      throw complaint("unknown; " + (near.empty() ? std::string() : "did you mean '" + near.front() + "'? ") +
                      "the keys here are " + joined(known));
    }
    if (!seen.insert(member.key).second) {
      throw complaint("is given twice; keep one");
    }
  }
}

std::optional<YamlValue> YamlMap::find(const std::string& key) const {
  const YamlNode* const child = m_node->find(key);
  if (child == nullptr) {
    return std::nullopt;
  }
  return part(*child, named(key));
}

YamlValue YamlMap::require(const std::string& key, const std::string& remedy) const {
  const auto value = find(key);
  if (!value) {
    throw InputError(place(m_node->line, m_node->column), named(key), "", remedy);
  }
  return *value;
}

std::vector<std::string> YamlMap::keys() const {
  std::vector<std::string> result;
  for (const YamlMember& member : m_node->members) {
    result.push_back(member.key);
  }
  return result;
}

void YamlMap::requireVersion() const {
  const YamlForm& form = m_document->form;
  const YamlValue version = require(form.versionKey(), "is missing; " + form.beginning());
  if (!version.is("1")) {
    throw version.error("is a version this release does not read; it reads 1, a number without quotes");
  }
}

void YamlMap::read(const std::string& key, std::string& target) const {
  if (const auto value = find(key)) {
    target = value->text();
  }
}

void YamlMap::read(const std::string& key, double& target, double low, double high) const {
  if (const auto value = find(key)) {
    target = value->number(low, high);
  }
}

void YamlMap::read(const std::string& key, bool& target) const {
  if (const auto value = find(key)) {
    target = value->boolean();
  }
}

}  // namespace metamer::spectral
