// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "map/known_points.h"
#include "metamer/sip/homogeneous_map.h"
#include "metamer/sip/spectral_transform.h"
#include "transform/perceptual_metric.h"

namespace metamer::sip {

/// What all parts of a map are built from. Holds on to the transform.
struct MapSource {
  /// @param tolerance, fewerLevels  as buildHomogeneousMap() takes them
  MapSource(const SpectralTransform& transform, double tolerance, int fewerLevels);

  /// No patch may be cut, so none is judged.
  bool isDraft() const { return fewerLevels == HomogeneousMap::kMaximumDepth; }

  const SpectralTransform& transform;
  double tolerance;
  int fewerLevels;
  Eigen::Matrix3d cubeFromRgb;
  Eigen::Matrix3d rgbFromCube;
  PerceptualMetric metric;
  std::vector<KnownPoint> known;
};

}  // namespace metamer::sip
