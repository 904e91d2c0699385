// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "metamer/stage/chart_difference.h"
#include "metamer/stage/rgb_wall.h"
#include "metamer/stage/stage_capture.h"

namespace metamer::stage {

/// A solved wall with what a report says of it.
struct StageResult {
  std::string name;
  StageCapture capture;
  WallSolution solution;
  /// Gain on the predicted chart before its differences are taken: it makes the white patch as green as the target's,
  /// since w_avg is known up to a factor (fig. 2.18). Q holds that factor, so there is none after it.
  double exposure = 1;
  std::vector<double> differencesBefore;  ///< CIEDE2000 of P (exposed) against T
  std::vector<double> differencesAfter;   ///< CIEDE2000 of Q P against T
  DifferenceSummary before, after, skinBefore, skinAfter;
  Eigen::Vector3d whiteRgb{1, 1, 1};         ///< what counted as white in the differences
  std::optional<double> spectralSimilarity;  ///< SSI of the wall's white drive to the target, where spectra are known
  std::vector<std::string> notes;            ///< of the input, and what is out of reach and why
};

/// @throws spectral::InputError, naming the stage file
StageResult solveStage(const StageDescription& description, StageCapture capture);

}  // namespace metamer::stage
