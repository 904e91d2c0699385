// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace metamer::lutgen {

/// What a stage file says of the patterns that were written for it.
struct StageSkeleton {
  double squareWidthM = 0;
  double squareHeightM = 0;
  double distanceM = 0;
  std::vector<double> ramp;  ///< drives of a channel's ramp
  /// The picture of a pattern, as a person finds it.
  std::function<std::string(const std::string& pattern)> picture;
};

/// A stage file (stage_description.h) that names what each capture is for. It parses; boxes and corners are empty, so
/// that nothing is solved from it before they are filled in.
std::string skeletonText(const StageSkeleton& skeleton);

}  // namespace metamer::lutgen
