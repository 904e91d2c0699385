// SPDX-License-Identifier: Apache-2.0
#include "metamer/ocio/shaper.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <vector>

#include "metamer/spectral/input_error.h"
#include "metamer/spectral/near_names.h"
#include "metamer/spectral/text.h"

namespace metamer::ocio {
namespace {

using spectral::LogEncoding;

/// signal = slope * log2(light + shift) + offset above the cut, a straight line of toeSlope below it.
struct CameraLog {
  double slope = 0;
  double shift = 0;
  double offset = 0;
  double cut = 0;
  double toeSlope = 0;

  double encode(double light) const {
    return light >= cut ? slope * std::log2(light + shift) + offset
                        : slope * std::log2(cut + shift) + offset + toeSlope * (light - cut);
  }
};

/// Root of a function that changes sign between two points.
double root(const std::function<double(double)>& f, double low, double high) {
  const bool rising = f(low) < 0.0;
  for (int halving = 0; halving < 200; ++halving) {
    const double middle = 0.5 * (low + high);
    ((f(middle) < 0.0) == rising ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

/// The parameters of a curve, solved from the curve itself, so that its constants stand in one place. Nothing where it
/// is not of this form.
std::optional<CameraLog> cameraLog(LogEncoding encoding) {
  const auto f = [encoding](double light) { return spectral::encode(encoding, light); };
  // Three points on the logarithm of every curve.
  constexpr double kLow = 0.02;
  constexpr double kMiddle = 0.5;
  constexpr double kHigh = 50.0;
  const double ratio = (f(kHigh) - f(kMiddle)) / (f(kMiddle) - f(kLow));
  CameraLog log;
  log.shift = root(
      [&](double shift) {
        return std::log((kHigh + shift) / (kMiddle + shift)) / std::log((kMiddle + shift) / (kLow + shift)) - ratio;
      },
      -0.999 * kLow, 1.0);
  log.slope = (f(kHigh) - f(kLow)) / std::log2((kHigh + log.shift) / (kLow + log.shift));
  log.offset = f(kHigh) - log.slope * std::log2(kHigh + log.shift);
  log.toeSlope = f(-1.0) - f(-2.0);
  log.cut = root([&](double light) { return std::abs(f(light) - (f(-1.0) + log.toeSlope * (light + 1.0))) - 1e-12; },
                 -1.0, kLow);
  for (double light = -2.0; light < 70000.0; light += 1e-3 + 0.01 * std::abs(light)) {
    if (std::abs(log.encode(light) - f(light)) > 1e-8) {
      return std::nullopt;
    }
  }
  return log;
}

/// Value of the half float of a bit pattern; infinities and NaN as the largest half and zero.
double halfValue(unsigned long bits) {
  const double sign = (bits & 0x8000u) != 0 ? -1.0 : 1.0;
  const int exponent = static_cast<int>((bits >> 10) & 0x1Fu);
  const int mantissa = static_cast<int>(bits & 0x3FFu);
  if (exponent == 0x1F) {
    return mantissa == 0 ? sign * 65504.0 : 0.0;
  }
  return exponent == 0 ? sign * std::ldexp(mantissa, -24) : sign * std::ldexp(1024 + mantissa, exponent - 25);
}

OCIO::TransformRcPtr displayTransform(const DisplayCurve& curve, OCIO::TransformDirection direction) {
  // OCIO's operators are from signal to light.
  const auto turned =
      direction == OCIO::TRANSFORM_DIR_FORWARD ? OCIO::TRANSFORM_DIR_INVERSE : OCIO::TRANSFORM_DIR_FORWARD;
  if (curve.gamma) {
    auto transform = OCIO::ExponentTransform::Create();
    transform->setValue({*curve.gamma, *curve.gamma, *curve.gamma, 1.0});
    transform->setNegativeStyle(OCIO::NEGATIVE_MIRROR);
    transform->setDirection(turned);
    return transform;
  }
  constexpr double kExponent = 2.4;
  constexpr double kOffset = 0.055;
  auto transform = OCIO::ExponentWithLinearTransform::Create();
  transform->setGamma({kExponent, kExponent, kExponent, 1.0});
  transform->setOffset({kOffset, kOffset, kOffset, 0.0});
  transform->setNegativeStyle(OCIO::NEGATIVE_MIRROR);
  transform->setDirection(turned);
  return transform;
}

}  // namespace

Shaper shaperFromName(const std::string& name) {
  if (const auto curve = displayCurveNamed(name)) {
    return *curve;
  }
  std::vector<std::string> names;
  for (const LogEncoding encoding : spectral::allLogEncodings()) {
    names.push_back(spectral::nameOf(encoding));
    if (spectral::lowerCase(names.back()) == spectral::lowerCase(name)) {
      return encoding;
    }
  }
  names.insert(names.end(), {"sRGB", "Rec.1886", "Gamma 2.2 (any number from 1 to 4)"});
  const std::string all = spectral::joined(names);
  const std::string asked = spectral::lowerCase(name);
  if (asked == "linear" || asked == "none" || asked == "raw") {
    throw spectral::InputError("", "shaper", name,
                               "is no curve: a table over linear light has no nodes in the dark and clips above 1; "
                               "name one of " +
                                   all);
  }
  throw spectral::InputError("", "shaper", name, "unknown; the shapers are " + all);
}

std::string nameOf(const Shaper& shaper) {
  const auto* display = std::get_if<DisplayCurve>(&shaper);
  return display != nullptr ? display->name() : spectral::nameOf(std::get<LogEncoding>(shaper));
}

double decode(const Shaper& shaper, double signal) {
  const auto* display = std::get_if<DisplayCurve>(&shaper);
  return display != nullptr ? display->decoded(signal) : spectral::decode(std::get<LogEncoding>(shaper), signal);
}

OCIO::TransformRcPtr shaperTransform(const Shaper& shaper, OCIO::TransformDirection direction) {
  if (const auto* display = std::get_if<DisplayCurve>(&shaper)) {
    return displayTransform(*display, direction);
  }
  const LogEncoding encoding = std::get<LogEncoding>(shaper);
  if (const auto log = cameraLog(encoding)) {
    auto transform = OCIO::LogCameraTransform::Create({log->cut, log->cut, log->cut});
    transform->setBase(2.0);
    transform->setLogSideSlopeValue({log->slope, log->slope, log->slope});
    transform->setLogSideOffsetValue({log->offset, log->offset, log->offset});
    transform->setLinSideSlopeValue({1.0, 1.0, 1.0});
    transform->setLinSideOffsetValue({log->shift, log->shift, log->shift});
    transform->setLinearSlopeValue({log->toeSlope, log->toeSlope, log->toeSlope});
    transform->setDirection(direction);
    return transform;
  }
  constexpr unsigned long kHalfCount = 65536;
  auto table = OCIO::Lut1DTransform::Create(kHalfCount, true);
  for (unsigned long bits = 0; bits < kHalfCount; ++bits) {
    const double x = halfValue(bits);
    const double y = direction == OCIO::TRANSFORM_DIR_FORWARD ? spectral::encode(encoding, x)
                                                              : spectral::decode(encoding, std::clamp(x, -4.0, 4.0));
    const auto value = static_cast<float>(std::clamp(y, -65504.0, 65504.0));
    table->setValue(bits, value, value, value);
  }
  return table;
}

}  // namespace metamer::ocio
