// SPDX-License-Identifier: Apache-2.0
#include "metamer/spectral/correlated_colour_temperature.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "light/planck.h"
#include "metamer/spectral/spectrum.h"

namespace metamer::spectral {
namespace {

using Curves = Eigen::Matrix<double, kDomainSize, 3>;

/// Temperatures in reciprocal megakelvin ("mired"), in which the locus is walked at an even pace.
constexpr double kFirstMired = 10;   // 100000 K
constexpr double kLastMired = 1000;  // 1000 K
constexpr int kSteps = 198;
/// Of these one is looked at first, then all round the nearest: the distance has one least value, but for colours far
/// from the locus.
constexpr int kStride = 9;
constexpr double kStepMired = (kLastMired - kFirstMired) / kSteps;
constexpr int kBisections = 60;

struct LocusPoint {
  Eigen::Vector2d uv;       ///< CIE 1960
  Eigen::Vector2d tangent;  ///< d uv / d mired
};

Eigen::Vector2d uv1960(const Eigen::Vector3d& xyz) {
  return Eigen::Vector2d(4.0 * xyz.x(), 6.0 * xyz.y()) / (xyz.x() + 15.0 * xyz.y() + 3.0 * xyz.z());
}

LocusPoint locusAt(double mired, const Curves& observer) {
  constexpr double kReferenceNm = 560;
  const double temperature = 1e6 / mired;
  const double reference = planckExponentialTerm(kReferenceNm, temperature);
  Eigen::Vector3d xyz = Eigen::Vector3d::Zero();
  Eigen::Vector3d xyzSlope = Eigen::Vector3d::Zero();
  for (int i = 0; i < kDomainSize; ++i) {
    const double nm = kDomainStartNm + i;
    const double divisor = planckExponentialTerm(nm, temperature);
    // Divided by the radiance at 560 nm, so that cool bodies do not underflow.
    const double power = std::pow(kReferenceNm / nm, 5) * reference / divisor;
    // d ln(power) / d mired; the factor at 560 nm scales X, Y and Z alike and drops out of u, v.
    const double slope = -power * (divisor + 1.0) / divisor * kSecondRadiationConstantNmK / nm * 1e-6;
    const Eigen::Vector3d response = observer.row(i).transpose();
    xyz += power * response;
    xyzSlope += slope * response;
  }
  const double divisor = xyz.x() + 15.0 * xyz.y() + 3.0 * xyz.z();
  const double divisorSlope = xyzSlope.x() + 15.0 * xyzSlope.y() + 3.0 * xyzSlope.z();
  const Eigen::Vector2d uv = uv1960(xyz);
  return {uv, (Eigen::Vector2d(4.0 * xyzSlope.x(), 6.0 * xyzSlope.y()) - uv * divisorSlope) / divisor};
}

}  // namespace

CorrelatedColourTemperature correlatedColourTemperature(const Eigen::Vector3d& xyz,
                                                        const Eigen::Matrix<double, 401, 3>& observer1931) {
  const Eigen::Vector2d target = uv1960(xyz);

  int nearest = 0;
  double least = std::numeric_limits<double>::infinity();
  const auto look = [&](int first, int last, int stride) {
    for (int step = first; step <= last; step += stride) {
      const double distance = (locusAt(kFirstMired + step * kStepMired, observer1931).uv - target).squaredNorm();
      if (distance < least) {
        least = distance;
        nearest = step;
      }
    }
  };
  look(0, kSteps, kStride);
  look(std::max(nearest - kStride + 1, 0), std::min(nearest + kStride - 1, kSteps), 1);
  const double best = kFirstMired + nearest * kStepMired;

  // The nearest point is where the tangent stands square on the line to the target: a sign change to bisect, exact to
  // rounding where the distance itself is flat.
  double low = std::fmax(best - kStepMired, kFirstMired);
  double high = std::fmin(best + kStepMired, kLastMired);
  for (int i = 0; i < kBisections; ++i) {
    const double middle = (low + high) / 2;
    const LocusPoint point = locusAt(middle, observer1931);
    const bool beyond = (point.uv - target).dot(point.tangent) > 0;
    (beyond ? high : low) = middle;
  }
  const double mired = (low + high) / 2;
  const Eigen::Vector2d offset = target - locusAt(mired, observer1931).uv;
  return {1e6 / mired, std::copysign(offset.norm(), offset.y())};
}

}  // namespace metamer::spectral
