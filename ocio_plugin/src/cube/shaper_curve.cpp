// SPDX-License-Identifier: Apache-2.0
#include "cube/shaper_curve.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "operators/chained.h"
#include "operators/grey_ramp.h"

namespace metamer::ocio {
namespace {

constexpr double kMiddleGrey = 0.18;
/// Where the curve turns from proportional to logarithmic: channels of saturated colours lie below their luminance.
constexpr double kStopsBelow = 4.0;
/// Cells for signals below black, of which colours within the gamut have none. A whole number: black lies on a node,
/// but for the curve's steps.
constexpr double kCellsBelowBlack = 1.0;

/// The light of grey signals, evenly spread over 0 ... 1.
std::vector<double> lightOfSignals(const Signal& signal, int count) {
  const std::vector<float> rgba = greyRamp(signal.toEngine, count);
  std::vector<double> light;
  light.reserve(static_cast<std::size_t>(count));
  for (std::size_t at = 1; at < rgba.size(); at += 4) {
    light.push_back(static_cast<double>(rgba[at]));
  }
  return light;
}

}  // namespace

OCIO::Lut1DTransformRcPtr shaperCurve(const Signal& signal, int size, double lowestStop, int entries) {
  const double dark = kMiddleGrey * std::exp2(lowestStop - kStopsBelow);
  const std::vector<double> light = lightOfSignals(signal, entries);
  const auto curve = [dark](double positive) { return std::log2(positive / dark + 1.0); };
  const double lowest = light.front();
  const double black = lowest < 0.0 ? kCellsBelowBlack / (size - 1) : 0.0;
  const double from = curve(std::max(lowest, 0.0));
  const double range = curve(light.back()) - from;
  auto table = OCIO::Lut1DTransform::Create(light.size(), false);
  for (std::size_t k = 0; k < light.size(); ++k) {
    const double axis =
        light[k] < 0.0 ? black * (1.0 - light[k] / lowest) : black + (1.0 - black) * (curve(light[k]) - from) / range;
    const auto value = static_cast<float>(axis);
    table->setValue(k, value, value, value);
  }
  return table;
}

Signal behindShaperCurve(const Signal& signal, const OCIO::ConstTransformRcPtr& shaperCurve) {
  const OCIO::TransformRcPtr back = shaperCurve->createEditableCopy();
  back->setDirection(OCIO::TRANSFORM_DIR_INVERSE);
  return {chained({back, signal.toEngine}), chained({signal.fromEngine, shaperCurve})};
}

OCIO::ConstLut1DTransformRcPtr leadingShaperCurve(const OCIO::ConstGroupTransformRcPtr& group) {
  if (group->getNumTransforms() < 2) {
    return nullptr;
  }
  const auto curve = OCIO::DynamicPtrCast<const OCIO::Lut1DTransform>(group->getTransform(0));
  if (!curve || curve->getDirection() != OCIO::TRANSFORM_DIR_FORWARD || curve->getInputHalfDomain()) {
    return nullptr;
  }
  std::array<float, 3> last = {0.0F, 0.0F, 0.0F};
  for (unsigned long k = 0; k < curve->getLength(); ++k) {
    std::array<float, 3> entry{};
    curve->getValue(k, entry[0], entry[1], entry[2]);
    for (std::size_t channel = 0; channel < 3; ++channel) {
      if (entry[channel] < last[channel] || (k == 0 && entry[channel] != 0.0F)) {
        return nullptr;
      }
    }
    last = entry;
  }
  return last == std::array{1.0F, 1.0F, 1.0F} ? curve : nullptr;
}

}  // namespace metamer::ocio
