// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <utility>

#include "metamer/sip/spectral_transform.h"
#include "metamer/spectral/input_error.h"

namespace metamer::sip {

namespace {

using Kind = ReferenceScene::Kind;

constexpr std::array<std::pair<Kind, const char*>, 9> kNames = {{{Kind::Natural, "natural"},
                                                                 {Kind::Skin, "skin"},
                                                                 {Kind::Smooth, "smooth"},
                                                                 {Kind::Dataset, "dataset"},
                                                                 {Kind::Pairs, "pairs"},
                                                                 {Kind::Smits, "smits"},
                                                                 {Kind::Mallett, "mallett"},
                                                                 {Kind::Jakob, "jakob"},
                                                                 {Kind::Meng, "meng"}}};

}  // namespace

std::string sceneKindRemedy(const std::string& name) {
  if (name == "otsu") {
    return "jumps from one colour to the next, and pictures would sparkle; take meng or jakob, or lutgen uplift for "
           "the spectra";
  }
  return "must be natural, skin, pairs, smooth, dataset, smits, mallett, jakob or meng";
}

std::optional<spectral::UpliftMethod> upliftOf(ReferenceScene::Kind kind) {
  switch (kind) {
    case Kind::Smits:
      return spectral::UpliftMethod::Smits;
    case Kind::Mallett:
      return spectral::UpliftMethod::Mallett;
    case Kind::Jakob:
      return spectral::UpliftMethod::Jakob;
    case Kind::Meng:
      return spectral::UpliftMethod::Meng;
    default:
      return std::nullopt;
  }
}

ReferenceScene::Kind sceneKindFromName(const std::string& name) {
  for (const auto& [kind, known] : kNames) {
    if (name == known) {
      return kind;
    }
  }
  throw spectral::InputError("scene", "kind", name, sceneKindRemedy(name));
}

std::string nameOf(ReferenceScene::Kind kind) {
  return std::find_if(kNames.begin(), kNames.end(), [&](const auto& known) { return known.first == kind; })->second;
}

}  // namespace metamer::sip
