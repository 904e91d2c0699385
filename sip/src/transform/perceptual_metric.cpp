// SPDX-License-Identifier: Apache-2.0
#include "transform/perceptual_metric.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace metamer::sip {

namespace {

constexpr double kProbeLuminance = 0.18;
constexpr double kLeastRelativeLuminance = 0.02;
constexpr double kNoLight = 0.01;
constexpr double kPerSize = 4.0;
constexpr double kLeastLuminance = 1e-30;

/// CIELAB's compression and its slope, the linear part continued below zero (CIE 015:2018, eq. 8.6).
struct Compressed {
  double value;
  double slope;
};
Compressed compress(double ratio) {
  constexpr double kKnee = 216.0 / 24389.0;
  constexpr double kLinearSlope = 841.0 / 108.0;
  if (ratio <= kKnee) {
    return {kLinearSlope * ratio + 4.0 / 29.0, kLinearSlope};
  }
  const double root = std::cbrt(ratio);
  return {root, 1.0 / (3.0 * root * root)};
}

}  // namespace

PerceptualMetric::PerceptualMetric(const spectral::RgbSpace& space)
    : m_relativeFromRgb(space.whiteXyz().cwiseInverse().asDiagonal() * space.xyzFromRgb()) {}

Eigen::Matrix3d PerceptualMetric::at(const Eigen::Vector3d& input, const Eigen::Vector3d& output) const {
  const Eigen::Vector3d in = m_relativeFromRgb * input;
  const double size = std::max(in.cwiseAbs().maxCoeff(), kLeastLuminance);
  if (in.y() < kNoLight * size) {
    return kPerSize / size * m_relativeFromRgb;
  }
  const double exposure = kProbeLuminance / std::max(in.y(), kLeastRelativeLuminance * size);
  return atRelative(exposure * (m_relativeFromRgb * output)) * (exposure * m_relativeFromRgb);
}

Eigen::Matrix3d PerceptualMetric::atRelative(const Eigen::Vector3d& ratio) {
  const Compressed x = compress(ratio.x());
  const Compressed y = compress(ratio.y());
  const Compressed z = compress(ratio.z());

  Eigen::Matrix3d labFromRatio;
  labFromRatio << 0.0, 116.0 * y.slope, 0.0,   //
      500.0 * x.slope, -500.0 * y.slope, 0.0,  //
      0.0, 200.0 * y.slope, -200.0 * z.slope;
  const double lightness = 116.0 * y.value - 16.0;
  const double b = 200.0 * (y.value - z.value);
  // CIEDE2000's stretch of a* near neutral, whose own slope is left out.
  double a = 500.0 * (x.value - y.value);
  const double seventh = std::pow(std::hypot(a, b) / 25.0, 7.0);
  const double stretch = 1.0 + 0.5 * (1.0 - std::sqrt(seventh / (seventh + 1.0)));
  labFromRatio.row(1) *= stretch;
  a *= stretch;
  const double chroma = std::hypot(a, b);
  const double cosine = chroma > 0.0 ? a / chroma : 1.0;
  const double sine = chroma > 0.0 ? b / chroma : 0.0;
  const double hue = std::atan2(b, a);

  // Sharma, Wu and Dalal 2005, eq. 15 to 22, for two colours that are one.
  constexpr double kDegree = std::numbers::pi / 180.0;
  const double hueWeight = 1.0 - 0.17 * std::cos(hue - 30.0 * kDegree) + 0.24 * std::cos(2.0 * hue) +
                           0.32 * std::cos(3.0 * hue + 6.0 * kDegree) - 0.20 * std::cos(4.0 * hue - 63.0 * kDegree);
  const double fromGrey = (lightness - 50.0) * (lightness - 50.0);
  const double lightnessScale = 1.0 + 0.015 * fromGrey / std::sqrt(20.0 + fromGrey);
  const double chromaScale = 1.0 + 0.045 * chroma;
  const double hueScale = 1.0 + 0.015 * chroma * hueWeight;
  const double chromaSeventh = std::pow(chroma / 25.0, 7.0);
  const double fromBlue = ((hue < 0.0 ? hue + 2.0 * std::numbers::pi : hue) / kDegree - 275.0) / 25.0;
  const double rotation = -2.0 * std::sqrt(chromaSeventh / (chromaSeventh + 1.0)) *
                          std::sin(60.0 * kDegree * std::exp(-fromBlue * fromBlue));
  // x^2 + rotation x y + y^2 as a sum of squares.
  const Eigen::RowVector2d chromaRow = Eigen::RowVector2d(cosine, sine) / chromaScale;
  const Eigen::RowVector2d hueRow = Eigen::RowVector2d(-sine, cosine) / hueScale;
  Eigen::Matrix3d weighted = Eigen::Matrix3d::Zero();
  weighted(0, 0) = 1.0 / lightnessScale;
  weighted.block<1, 2>(1, 1) = chromaRow + 0.5 * rotation * hueRow;
  weighted.block<1, 2>(2, 1) = std::sqrt(std::max(0.0, 1.0 - 0.25 * rotation * rotation)) * hueRow;
  return weighted * labFromRatio;
}

}  // namespace metamer::sip
