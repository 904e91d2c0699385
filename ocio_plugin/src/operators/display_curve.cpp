// SPDX-License-Identifier: Apache-2.0
#include "metamer/ocio/display_curve.h"

#include <cmath>

#include "metamer/spectral/srgb_curve.h"
#include "metamer/spectral/text.h"

namespace metamer::ocio {

namespace {

/// Of ITU-R BT.1886 with a black of no light.
constexpr double kRec1886 = 2.4;

}  // namespace

double DisplayCurve::decoded(double signal) const {
  return gamma ? std::copysign(std::pow(std::abs(signal), *gamma), signal) : spectral::linearFromSrgb(signal);
}

double DisplayCurve::encoded(double light) const {
  return gamma ? std::copysign(std::pow(std::abs(light), 1.0 / *gamma), light) : spectral::srgbFromLinear(light);
}

std::string DisplayCurve::name() const {
  return !gamma ? "sRGB" : *gamma == kRec1886 ? "Rec.1886" : "Gamma " + spectral::numberText(*gamma);
}

std::optional<DisplayCurve> displayCurveNamed(const std::string& name) {
  const std::string lower = spectral::lowerCase(spectral::trimmed(name));
  if (lower == "srgb") {
    return DisplayCurve{};
  }
  if (lower == "rec.1886" || lower == "bt.1886") {
    return DisplayCurve{kRec1886};
  }
  if (lower.rfind("gamma", 0) == 0) {
    const auto number = spectral::parseNumber(lower.substr(5));
    if (number && *number >= 1.0 && *number <= 4.0) {
      return DisplayCurve{*number};
    }
  }
  return std::nullopt;
}

}  // namespace metamer::ocio
