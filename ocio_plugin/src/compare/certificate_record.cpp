// SPDX-License-Identifier: Apache-2.0
#include "metamer/ocio/certificate_record.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <utility>

#include "compare/certificate_parts.h"
#include "metamer/spectral/input_error.h"
#include "metamer/spectral/message_line.h"
#include "metamer/spectral/path_text.h"
#include "metamer/spectral/spectral_files.h"
#include "metamer/spectral/text.h"

namespace metamer::ocio {
namespace {

using spectral::InputError;
using Json = nlohmann::ordered_json;

constexpr int kDeepest = 16;
/// Of the parser's reason, which quotes what it read.
constexpr std::size_t kLongestReason = 150;
/// Certificates nest five deep; a deeper text than this would only overrun the stack.
constexpr int kDeepestNesting = 64;
/// They have some hundred fields; a document that keeps their order takes the square of their number in time.
constexpr std::size_t kMostFields = 10'000;
constexpr std::size_t kShownOfHash = 8;
constexpr std::size_t kLongestValue = 80;

/// A value of a certificate by its path below a part, in the order of the file.
struct Field {
  std::string path;
  std::string value;
  std::string name;
};

void flatten(const Json& value, const std::string& path, int depth, std::vector<Field>& fields) {
  const bool hasNumbers = value.is_array() && !value.empty() && value.front().is_number();
  if (depth > kDeepest || !value.is_structured() || value.empty() || hasNumbers) {
    fields.push_back({path, value.dump(-1, ' ', false, Json::error_handler_t::replace), ""});
    return;
  }
  for (const auto& [key, member] : value.items()) {
    const std::string step = value.is_array() ? "[" + key + "]" : (path.empty() ? "" : ".") + key;
    flatten(member, path + step, depth + 1, fields);
  }
}

std::string textOf(const Json& object, const char* key) {
  const auto found = object.is_object() ? object.find(key) : object.end();
  return found != object.end() && found->is_string() ? found->get<std::string>() : std::string();
}

/// The fields of a part. Inputs stand by their roles: one more does not shift the others.
std::vector<Field> fieldsOf(const Json& document, const std::string& part) {
  std::vector<Field> fields;
  const auto found = document.find(part);
  if (found == document.end()) {
    return fields;
  }
  if (part != "inputs" || !found->is_array()) {
    flatten(*found, "", 0, fields);
    return fields;
  }
  for (const Json& input : *found) {
    for (const char* key : {"name", "file", "sha256"}) {
      const std::string value = textOf(input, key);
      if (!value.empty()) {
        fields.push_back({textOf(input, "role") + "." + key,
                          Json(value).dump(-1, ' ', false, Json::error_handler_t::replace), textOf(input, "name")});
      }
    }
  }
  return fields;
}

std::unordered_map<std::string, const Field*> byPath(const std::vector<Field>& fields) {
  std::unordered_map<std::string, const Field*> places;
  for (const Field& field : fields) {
    places.emplace(field.path, &field);
  }
  return places;
}

/// A hash by its first digits, a long text by its start, JSON's quotation marks taken off.
std::string shown(const std::string& value, bool isHash) {
  std::string text = value;
  if (text.size() >= 2 && text.front() == '"' && text.back() == '"') {
    text = text.substr(1, text.size() - 2);
  }
  return isHash ? spectral::messageLine(text.substr(0, kShownOfHash)) : spectral::shortened(text, kLongestValue);
}

bool endsWith(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

}  // namespace

Json certificateJson(const std::string& text) {
  std::size_t fields = 0;
  return Json::parse(text, [&](int depth, Json::parse_event_t event, const Json&) {
    fields += event == Json::parse_event_t::key ? 1 : 0;
    if (depth > kDeepestNesting || fields > kMostFields) {
      throw InputError("", "certificate", "",
                       depth > kDeepestNesting ? "nests too deep for one of metamer's; bake the file again"
                                               : "has more fields than any of metamer's; bake the file again");
    }
    return true;
  });
}

void compareParts(const Json& a, const Json& b, const std::string& part, std::vector<CertificateChange>& changes) {
  const std::vector<Field> before = fieldsOf(a, part);
  const std::vector<Field> after = fieldsOf(b, part);
  const auto then = byPath(before);
  const auto now = byPath(after);
  for (const Field& field : before) {
    const auto found = now.find(field.path);
    if (found == now.end() || found->second->value != field.value) {
      changes.push_back({part, field.path, field.value, found == now.end() ? "" : found->second->value, field.name});
    }
  }
  for (const Field& field : after) {
    if (then.find(field.path) == then.end()) {
      changes.push_back({part, field.path, "", field.value, field.name});
    }
  }
}

CertificateRecord certificateFrom(const std::string& text, const std::string& where) {
  try {
    const Json json = certificateJson(text);
    if (!json.is_object() || !json.contains("metamer_certificate")) {
      throw InputError(where, "certificate", "", "is not one of metamer's; give the FILE.json that bake wrote");
    }
    const Json& error = json.at("error");
    CertificateRecord record{where,
                             text,
                             textOf(json.at("tool"), "version"),
                             error.at("mean").get<double>(),
                             error.at("p99").get<double>(),
                             error.at("max").get<double>(),
                             textOf(json.at("transform"), "sha256")};
    if (!std::isfinite(record.mean) || !std::isfinite(record.p99) || !std::isfinite(record.max)) {
      throw InputError(where, "error", "", "is no finite number; bake the file again");
    }
    return record;
  } catch (const nlohmann::json::exception& error) {
    throw InputError(
        where, "certificate", "",
        "is not one of metamer's; bake the file again: " + spectral::messageLine(error.what(), kLongestReason));
  }
}

CertificateRecord readCertificate(const std::filesystem::path& file) {
  return certificateFrom(spectral::readTextFile(file), spectral::utf8(file));
}

std::vector<CertificateChange> changesBetween(const CertificateRecord& before, const CertificateRecord& after) {
  const Json a = certificateJson(before.text);
  const Json b = certificateJson(after.text);
  std::vector<std::string> parts = {"recipe", "inputs",         "transform", "range",
                                    "error",  "graphics_cards", "pixels",    "diagnostics"};
  for (const Json* document : {&a, &b}) {
    for (const auto& [key, value] : document->items()) {
      if (std::find(parts.begin(), parts.end(), key) == parts.end()) {
        parts.push_back(key);
      }
    }
  }
  std::vector<CertificateChange> changes;
  for (const std::string& part : parts) {
    compareParts(a, b, part, changes);
  }
  return changes;
}

std::string CertificateChange::words() const {
  const bool isHash = endsWith(field, "sha256");
  if (part == "inputs" && isHash && !before.empty() && !after.empty()) {
    return "inputs: " + field.substr(0, field.rfind('.')) + ": the contents of " + name + " changed, sha256 " +
           shown(before, true) + "... is " + shown(after, true) + "... now";
  }
  const std::string what = spectral::messageLine(part + (field.empty() ? "" : ": " + field));
  if (before.empty()) {
    return what + " is new: " + shown(after, isHash);
  }
  if (after.empty()) {
    return what + " is gone: was " + shown(before, isHash);
  }
  return what + " was " + shown(before, isHash) + ", is " + shown(after, isHash);
}

}  // namespace metamer::ocio
