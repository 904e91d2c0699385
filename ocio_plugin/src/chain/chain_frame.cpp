// SPDX-License-Identifier: Apache-2.0
#include "chain/chain_frame.h"

#include <Eigen/LU>

#include "operators/ap1.h"

namespace metamer::ocio {
namespace {

/// How much of the mean of the three channels is added to each: the more, the fewer colours have one below zero, and
/// the finer a table must be for the rest.
constexpr double kInputMean = 8.0;
constexpr double kOutputMean = 1.5;

Eigen::Matrix3d withMean(double part) {
  return (Eigen::Matrix3d::Identity() + Eigen::Matrix3d::Constant(part / 3.0)) / (1.0 + part);
}

/// What the degree of adaptation makes of a picture, as a matrix on RGB; the identity where it is none.
Eigen::Matrix3d castOf(const sip::TransformSpec& spec, const sip::SpectralTransform& transform) {
  const Eigen::Matrix3d conesFromRgb = spectral::lmsFromXyz(spec.cat) * spec.space.xyzFromRgb();
  const Eigen::Vector3d white = Eigen::Vector3d::Ones();
  const Eigen::Vector3d gain = (conesFromRgb * transform.apply(white)).cwiseQuotient(conesFromRgb * white);
  if (!gain.allFinite() || !(gain.minCoeff() > 0.0)) {
    return Eigen::Matrix3d::Identity();
  }
  return conesFromRgb.inverse() * gain.asDiagonal() * conesFromRgb;
}

}  // namespace

ChainFrame chainFrame(const sip::TransformSpec& spec, const sip::SpectralTransform& transform) {
  // Whatever the working space.
  const spectral::RgbSpace wide{"", ap1Primaries(), spec.space.white};
  const Eigen::Matrix3d wideFromRgb = wide.rgbFromXyz() * spec.space.xyzFromRgb();
  return {withMean(kInputMean) * wideFromRgb, withMean(kOutputMean) * wideFromRgb * castOf(spec, transform).inverse()};
}

}  // namespace metamer::ocio
