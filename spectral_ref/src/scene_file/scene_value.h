// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "metamer/spectral/yaml_value.h"
#include "metamer/spectral_ref/scene.h"

namespace metamer::spectral_ref {

using spectral::YamlMap;
using spectral::YamlValue;

/// Three numbers, such as a place.
Vector3 vectorOf(const YamlValue& value);

/// Parses a scene file's text. @throws spectral::InputError with line and column
YamlValue parseSceneText(const std::string& text, const std::string& where);

}  // namespace metamer::spectral_ref
