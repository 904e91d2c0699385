// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace metamer::spectral {

/// Parses JSON from outside.
/// @throws InputError where it is malformed (with the byte), nested deeper than 32, or repeats a key of one object
nlohmann::json parseJson(std::string_view text, const std::string& where);

/// Member `key` of an object; a null value where it is absent or `parent` is no object.
const nlohmann::json& member(const nlohmann::json& parent, const std::string& key);

/// A member that must be text. @throws InputError where it is absent, empty or no text
std::string requiredText(const nlohmann::json& parent, const std::string& key, const std::string& where);

/// A member that may be absent or null. @throws InputError where it is something else than text
std::string optionalText(const nlohmann::json& parent, const std::string& key, const std::string& where);

/// A value as one line, for messages.
std::string valueText(const nlohmann::json& value);

}  // namespace metamer::spectral
