// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "chain/chromaticity_plane.h"

namespace metamer::ocio {

/// Ticks of a table lie on multiples of 1 / tickSteps(size), so that a curve with this many steps bends at them
/// exactly. A small table's error is far above what finer steps would save, and its curve would be most of its file.
constexpr int tickSteps(int size) {
  return size < 48 ? 1024 : 4096;
}

using PlaneTicks = std::array<std::vector<double>, 2>;

struct PlacedTicks {
  PlaneTicks ticks;
  double bending = 0;  ///< what is left to err, up to a factor that depends on the count alone
};

/// Ticks that crowd where the transform bends, along either coordinate, as seen on a grid of probes. White gets a tick.
PlacedTicks placeTicks(const PlaneTicks& probes, const ChromaticityPlane& plane,
                       const sip::SpectralTransform& transform, int count);

/// Ticks moved toward the strips that err most.
/// @param strips  along either coordinate: the error between a tick and the next
PlaneTicks movedTicks(const PlaneTicks& ticks, const PlaneTicks& strips, const Eigen::Vector2d& white);

std::vector<double> evenTicks(int count);

/// Ticks with others evenly between.
std::vector<double> subdivided(const std::vector<double>& ticks, int parts);

}  // namespace metamer::ocio
