// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "metamer/sip/spectral_transform.h"
#include "transform/perceptual_metric.h"

namespace metamer::sip {

/// A colour whose spectrum a transform knows, on the front face of the cube of directions: patches are checked there.
struct KnownPoint {
  Eigen::Vector2d place;   ///< 0 ... 1 along both of the face's axes
  Eigen::Vector3d value;   ///< what it becomes
  Eigen::Matrix3d metric;  ///< length of metric * error is about CIEDE2000
};

/// Of the colours that a transform knows, those whose largest cube coordinate is the third.
std::vector<KnownPoint> knownPoints(const SpectralTransform& transform, const Eigen::Matrix3d& cubeFromRgb,
                                    const PerceptualMetric& metric);

}  // namespace metamer::sip
