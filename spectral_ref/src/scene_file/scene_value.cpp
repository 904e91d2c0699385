// SPDX-License-Identifier: Apache-2.0
#include "scene_file/scene_value.h"

#include <vector>

namespace metamer::spectral_ref {

Vector3 vectorOf(const YamlValue& value) {
  // Far beyond any scene, well within single precision.
  constexpr double kFarthest = 1e9;
  const std::vector<double> values = value.numbers(-kFarthest, kFarthest);
  if (values.size() != 3) {
    throw value.error("must be three numbers, such as [0, 0, 1]");
  }
  return {values[0], values[1], values[2]};
}

YamlValue parseSceneText(const std::string& text, const std::string& where) {
  // Far more than any scene has, and the parser's stack holds it.
  constexpr int kDeepest = 64;
  constexpr int kMostNodes = 4'000'000;
  return YamlValue::parse(text, where,
                          {.name = "scene", .deepest = kDeepest, .mostNodes = kMostNodes, .saysColumns = true});
}

}  // namespace metamer::spectral_ref
