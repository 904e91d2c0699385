// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "metamer/spectral/data_library.h"
#include "metamer/spectral_ref/scene.h"

namespace metamer::validation {

/// Flat patches in a plane, seen straight on.
struct Chart {
  std::vector<std::string> names;
  std::vector<spectral::DomainSamples> reflectances;
};

/// How the chart is lit.
enum class Stage {
  SmallLamp,    ///< by a small lamp: direct light alone
  OpenBox,      ///< by the same lamp between a red and a green wall, light from wall to wall included
  Square,       ///< by a square of 1 m x 1 m, 1 m away and parallel: the calibration of an LED wall
  Surrounding,  ///< by an even sphere of light
};

/// A chart under a light, as the renderer takes it; its film holds the observer's own three responses.
/// @param walls  reflectances of the box's left and right wall, and of the rest
spectral_ref::Scene sceneOf(const Chart& chart, Stage stage, const spectral::DomainSamples& radiance,
                            const spectral::Observer& observer, const std::array<spectral::DomainSamples, 3>& walls);

/// Means of the patches' responses (3 x patches), one matrix a replicate: renders with seeds of their own.
/// @param samples  paths a pixel in each replicate
std::vector<Eigen::Matrix3Xd> renderPatches(const spectral_ref::Scene& scene, const Chart& chart, int replicates,
                                            int samples, std::uint32_t seed, int threads);

/// Over the replicates.
Eigen::Matrix3Xd meanOf(const std::vector<Eigen::Matrix3Xd>& replicates);

}  // namespace metamer::validation
