// SPDX-License-Identifier: Apache-2.0
#include "map/perceptual_metric.h"

#include <cmath>

namespace metamer::sip {

namespace {

constexpr double kProbeLuminance = 0.18;
constexpr double kLeastRelativeLuminance = 0.02;

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
    : m_xyzFromRgb(space.xyzFromRgb()),
      m_relativeFromRgb(space.whiteXyz().cwiseInverse().asDiagonal() * m_xyzFromRgb) {}

Eigen::Matrix3d PerceptualMetric::at(const Eigen::Vector3d& input, const Eigen::Vector3d& output) const {
  const double largest = (m_relativeFromRgb * input).cwiseAbs().maxCoeff();
  const double luminance = std::max({m_xyzFromRgb.row(1).dot(input), kLeastRelativeLuminance * largest, 1e-30});
  const double exposure = kProbeLuminance / luminance;
  const Eigen::Vector3d ratio = exposure * (m_relativeFromRgb * output);
  const Compressed x = compress(ratio.x());
  const Compressed y = compress(ratio.y());
  const Compressed z = compress(ratio.z());

  Eigen::Matrix3d labFromRatio;
  labFromRatio << 0.0, 116.0 * y.slope, 0.0,   //
      500.0 * x.slope, -500.0 * y.slope, 0.0,  //
      0.0, 200.0 * y.slope, -200.0 * z.slope;
  const double a = 500.0 * (x.value - y.value);
  const double b = 200.0 * (y.value - z.value);
  const double chroma = std::hypot(a, b);
  // CIEDE2000's stretch of a* near neutral.
  const double ratio25 = chroma / 25.0;
  const double seventh = std::pow(ratio25, 7.0);
  labFromRatio.row(1) *= 1.0 + 0.5 * (1.0 - std::sqrt(seventh / (seventh + 1.0)));

  const double cosine = chroma > 0.0 ? a / chroma : 1.0;
  const double sine = chroma > 0.0 ? b / chroma : 0.0;
  Eigen::Matrix3d weighted;
  weighted << 1.0, 0.0, 0.0,                                                //
      0.0, cosine / (1.0 + 0.045 * chroma), sine / (1.0 + 0.045 * chroma),  //
      0.0, -sine / (1.0 + 0.015 * chroma), cosine / (1.0 + 0.015 * chroma);
  return weighted * labFromRatio * exposure * m_relativeFromRgb;
}

}  // namespace metamer::sip
