// SPDX-License-Identifier: Apache-2.0
#include "chain/chromaticity_plane.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace metamer::ocio {
namespace {

/// The cone holds every colour with r, g, b not below -kReach times its lightness: this part of it luminance, the rest
/// their mean. So wide that it holds what lights can have; white lies in its middle.
constexpr double kReach = 2.0;
constexpr double kLuminancePart = 0.8;
/// Steps along a side of the triangle at which the transform is tried.
constexpr int kSteps = 24;
/// The sum of what comes out is to be positive: least share of it in the size.
constexpr double kLeastShare = 0.05;

/// Coordinates of the cone, so small that their sum, and the amount, stay below the largest float.
Eigen::Matrix3d coneFromRgb(const Eigen::RowVector3d& luminance) {
  const Eigen::RowVector3d lightness =
      kLuminancePart * luminance + Eigen::RowVector3d::Constant((1.0 - kLuminancePart) / 3.0);
  return (Eigen::Matrix3d::Identity() + kReach * Eigen::Vector3d::Ones() * lightness) / (4.0 * (1.0 + kReach));
}

/// The frame with given numerators of a and b, and their denominator.
ChromaticityFrame frameOf(const Eigen::RowVector3d& first, const Eigen::RowVector3d& second,
                          const Eigen::RowVector3d& sum, double offset) {
  ChromaticityFrame frame;
  frame.offset = offset;
  frame.fromRgb.row(0) = first;
  frame.fromRgb.row(1) = second + offset * sum;
  frame.fromRgb.row(2) = sum - first - second - offset * sum;
  return frame;
}

/// The frame of what comes out.
/// @param results  of the transform, all over the cone
ChromaticityFrame outputFrame(const Eigen::Matrix3d& cone, const sip::SpectralTransform& transform,
                              const std::vector<Eigen::Vector3d>& results, const Eigen::RowVector3d& luminance) {
  const Eigen::FullPivLU<Eigen::Matrix3d> linear(transform.linearMatrix());
  if (linear.isInvertible()) {
    const Eigen::Matrix3d back = cone * linear.inverse();
    const bool isPositive = std::all_of(results.begin(), results.end(), [&](const Eigen::Vector3d& rgb) {
      const Eigen::Vector3d p = back * rgb;
      return std::min(p.sum(), p.sum() + p[1]) >= kLeastShare * p.cwiseAbs().sum();
    });
    if (isPositive) {
      return frameOf(back.row(0), back.row(1), back.colwise().sum(), 1.0);
    }
  }
  // Luminance stays above a part of what went in, whatever the lights: a sum that cannot vanish. The amount is kept
  // above zero by the offset.
  const Eigen::Matrix3d adapted = transform.adaptationMatrix().inverse();
  const Eigen::Matrix3d back = cone * adapted;
  const Eigen::RowVector3d sum = cone.sum() * luminance * adapted;
  double lowest = 0.0;
  for (const Eigen::Vector3d& rgb : results) {
    const double s = sum * rgb;
    lowest = std::min(lowest, s > 0.0 ? back.row(1).dot(rgb) / s : 0.0);
  }
  return frameOf(back.row(0), back.row(1), sum, 1.0 - 1.25 * lowest);
}

}  // namespace

Eigen::Vector3d ChromaticityFrame::coordinates(const Eigen::Vector3d& rgb) const {
  const Eigen::Vector3d p = fromRgb * rgb;
  const double sum = p.sum();
  return {p[0] / sum, p[1] / sum - offset, p[1] > 0.0 ? std::log2(p[1]) : std::numeric_limits<double>::quiet_NaN()};
}

Eigen::Vector3d ChromaticityFrame::colour(const Eigen::Vector3d& coordinates) const {
  const double amount = std::exp2(coordinates[2]);
  const double sum = amount / (coordinates[1] + offset);
  const Eigen::Vector3d p(coordinates[0] * sum, amount, sum - coordinates[0] * sum - amount);
  return fromRgb.inverse() * p;
}

bool ChromaticityPlane::isVisible(const Eigen::Vector3d& rgb) const {
  const Eigen::Vector3d xyz = xyzFromRgb * rgb;
  return xyz.sum() > 0.0 && locus.contains(xyz.head<2>() / xyz.sum());
}

ChromaticityPlane chromaticityPlane(const sip::TransformSpec& spec, const sip::SpectralTransform& transform) {
  const Eigen::Matrix3d xyzFromRgb = transform.space().xyzFromRgb();
  const Eigen::RowVector3d luminance = xyzFromRgb.row(1) / xyzFromRgb.row(1).sum();
  const Eigen::Matrix3d cone = coneFromRgb(luminance);
  const Eigen::Matrix3d rgbFromCone = cone.inverse();
  std::vector<Eigen::Vector3d> results;
  for (int i = 0; i <= kSteps; ++i) {
    for (int j = 0; i + j <= kSteps; ++j) {
      results.push_back(transform.apply(rgbFromCone * Eigen::Vector3d(i, j, kSteps - i - j) / kSteps));
    }
  }
  ChromaticityPlane plane{cone,
                          frameOf(cone.row(0), cone.row(1), cone.colwise().sum(), 1.0),
                          outputFrame(cone, transform, results, luminance),
                          {},
                          sip::SpectralLocus(spec.standardObserver),
                          xyzFromRgb};
  plane.white = plane.input.coordinates(Eigen::Vector3d::Ones()).head<2>();
  return plane;
}

}  // namespace metamer::ocio
