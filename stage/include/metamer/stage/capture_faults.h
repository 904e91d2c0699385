// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "metamer/stage/chart_expectation.h"
#include "metamer/stage/rgb_wall.h"

namespace metamer::stage {

/// A mistake that a capture shows, in the words of a refusal: `field` `value` `remedy`.
struct CaptureFault {
  std::string field;   ///< of the stage file: "charts.red", "primaries"
  std::string value;   ///< the patch, or the numbers; may be empty
  std::string remedy;  ///< what is wrong, by how much, and what to do
};

/// What one chart's own values show, by what its reflectances allow: values that are coded for a display; patches in
/// another order (mirrored, turned, shifted by a patch or part of one); a veil of light over all; single patches that
/// are clipped, veiled or shaded.
///
/// Thresholds stand three times above what honest captures show: seven cameras, seven lights and three walls, noise of
/// up to 3 %, uneven light of 5 % and another copy of the chart.
/// @param field  what the faults call the chart
/// @param names  of the chart's patches
std::vector<CaptureFault> chartFaults(const ChartExpectation& expectation, const Eigen::Matrix3Xd& chart,
                                      const std::vector<std::string>& names, const std::string& field);

/// What a wall's captures show together, beside each chart's own faults: captures used twice or mixed up, channels or
/// columns swapped, wrong names, primaries of another exposure than the charts, light of other channels.
///
/// A capture that cannot be solved at all (dead or collinear channels) has none: solveWall names what is wrong with it.
/// @param expectation  of the chart; without it, only what colours alone tell
/// @param whitePatch   stands for greys where there is no expectation; -1: none
std::vector<CaptureFault> captureFaults(const WallCapture& capture, const std::optional<ChartExpectation>& expectation,
                                        int whitePatch);

}  // namespace metamer::stage
