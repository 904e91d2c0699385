// SPDX-License-Identifier: Apache-2.0
#include "metamer/sip/balance.h"

#include <array>
#include <utility>

#include "metamer/spectral/input_error.h"
#include "metamer/spectral/text.h"

namespace metamer::sip {

namespace {

using Kind = Balance::Kind;

constexpr std::array<std::pair<Kind, const char*>, 3> kNames = {
    {{Kind::Camera, "camera"}, {Kind::Rgb, "rgb"}, {Kind::None, "none"}}};

}  // namespace

Balance balanceFromName(const std::string& name) {
  for (const auto& [kind, known] : kNames) {
    if (spectral::lowerCase(name) == known) {
      return {.kind = kind};
    }
  }
  try {
    return {.kind = Kind::Cat, .cat = spectral::chromaticAdaptationFromName(name)};
  } catch (const spectral::InputError&) {
    throw spectral::InputError("", "balanced", name, kBalanceRemedy);
  }
}

std::string nameOf(const Balance& balance) {
  for (const auto& [kind, known] : kNames) {
    if (balance.kind == kind) {
      return known;
    }
  }
  return spectral::nameOf(balance.cat);
}

}  // namespace metamer::sip
