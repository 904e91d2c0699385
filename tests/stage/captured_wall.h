// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>

#include "metamer/stage/chart_expectation.h"
#include "metamer/stage/rgb_wall.h"
#include "metamer/stage/wall_intervals.h"

namespace metamer::stage {

/// What a camera would see of a wall of model LEDs, without noise, and of a light.
/// @param wall          0 ... 2: three sets of LEDs
/// @param reflectances  the copy of the chart that stands there
WallCapture capturedWall(const std::string& camera, const std::string& target, int wall = 0,
                         const std::string& reflectances = "colorchecker");

/// What is known of its chart.
std::optional<ChartExpectation> expectedChart(const WallCapture& capture);

/// With independent relative noise on every value.
WallCapture withNoise(const WallCapture& capture, double relative, std::uint64_t seed);

}  // namespace metamer::stage
