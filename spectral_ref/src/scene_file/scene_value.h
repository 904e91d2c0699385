// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "metamer/spectral/yaml_value.h"
#include "metamer/spectral_ref/scene.h"

namespace metamer::spectral_ref {

using spectral::YamlMap;
using spectral::YamlValue;

/// Runs a look-up and says in its error where in the scene the name stands.
template <typename Look>
auto lookUp(const YamlValue& value, const Look& look) {
  try {
    return look();
  } catch (const spectral::InputError& error) {
    throw value.error("", error.what());
  }
}

/// Three numbers, such as a place.
Vector3 vectorOf(const YamlValue& value);

/// Parses a scene file's text. @throws spectral::InputError with line and column
YamlValue parseSceneText(const std::string& text, const std::string& where);

}  // namespace metamer::spectral_ref
