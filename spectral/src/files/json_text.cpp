// SPDX-License-Identifier: Apache-2.0
#include "files/json_text.h"

#include <set>
#include <vector>

#include "metamer/spectral/input_error.h"
#include "metamer/spectral/spectral_files.h"
#include "metamer/spectral/text.h"

namespace metamer::spectral {
namespace {

constexpr int kDeepestNesting = 32;

}  // namespace

nlohmann::json parseJson(std::string_view text, const std::string& where) {
  using Event = nlohmann::json::parse_event_t;
  text = checkedUtf8(text, where);
  std::vector<std::set<std::string>> openObjects;
  const auto check = [&](int depth, Event event, nlohmann::json& parsed) {
    if (depth > kDeepestNesting) {
      throw InputError(where, "JSON", "", "is nested deeper than " + std::to_string(kDeepestNesting));
    }
    if (event == Event::object_start) {
      openObjects.emplace_back();
    } else if (event == Event::object_end) {
      openObjects.pop_back();
    } else if (event == Event::key && !openObjects.back().insert(parsed.get<std::string>()).second) {
      throw InputError(where, "JSON key", parsed.get<std::string>(), "appears twice in one object; keep one");
    }
    return true;
  };
  try {
    return nlohmann::json::parse(text.begin(), text.end(), check);
  } catch (const nlohmann::json::parse_error& error) {
    throw InputError(where, "JSON", "",
                     "malformed at byte " + std::to_string(error.byte) + "; the file may be cut short");
  } catch (const nlohmann::json::exception&) {
    throw InputError(where, "JSON", "", "holds a number out of range");
  }
}

const nlohmann::json& member(const nlohmann::json& parent, const std::string& key) {
  static const nlohmann::json kNull;
  if (!parent.is_object()) {
    return kNull;
  }
  const auto found = parent.find(key);
  return found == parent.end() ? kNull : *found;
}

std::string requiredText(const nlohmann::json& parent, const std::string& key, const std::string& where) {
  std::string text = optionalText(parent, key, where);
  if (text.empty()) {
    throw InputError(where, key, "", "is missing");
  }
  return text;
}

std::string optionalText(const nlohmann::json& parent, const std::string& key, const std::string& where) {
  const nlohmann::json& value = member(parent, key);
  if (value.is_null()) {
    return {};
  }
  if (!value.is_string()) {
    throw InputError(where, key, valueText(value), "must be text in quotes");
  }
  return value.get<std::string>();
}

std::string valueText(const nlohmann::json& value) {
  return value.is_string() ? value.get<std::string>() : value.dump();
}

}  // namespace metamer::spectral
