// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "metamer/sip/spectral_transform.h"
#include "metamer/spectral/input_error.h"

namespace metamer::sip {

namespace {

using Kind = ReferenceScene::Kind;

constexpr std::array<std::pair<Kind, const char*>, 5> kNames = {{{Kind::Natural, "natural"},
                                                                 {Kind::Skin, "skin"},
                                                                 {Kind::Smooth, "smooth"},
                                                                 {Kind::Dataset, "dataset"},
                                                                 {Kind::Pairs, "pairs"}}};

}  // namespace

ReferenceScene::Kind sceneKindFromName(const std::string& name) {
  for (const auto& [kind, known] : kNames) {
    if (name == known) {
      return kind;
    }
  }
  throw spectral::InputError("scene", "kind", name, kSceneKindRemedy);
}

std::string nameOf(ReferenceScene::Kind kind) {
  return std::find_if(kNames.begin(), kNames.end(), [&](const auto& known) { return known.first == kind; })->second;
}

}  // namespace metamer::sip
