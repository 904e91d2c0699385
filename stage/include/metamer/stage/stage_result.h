// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "metamer/stage/chart_difference.h"
#include "metamer/stage/rgb_wall.h"
#include "metamer/stage/skin_priority.h"
#include "metamer/stage/stage_capture.h"
#include "metamer/stage/wall_intervals.h"

namespace metamer::stage {

/// How a stage is solved, beside what its file says.
struct SolveChoices {
  /// Captures that show a mistake (captureFaults) are solved all the same, with a note for each.
  bool asCaptured = false;
  int samples = 500;  ///< of the intervals, 20 or more; fewer where there are thousands of patches. 0: no intervals
  std::uint64_t seed = 1;
  RunAll runAll;  ///< empty: one after another
};

/// Where the noise of the intervals is from.
struct NoiseSource {
  CaptureNoise noise;
  std::string words;  ///< "stated", "estimated from the charts", "assumed"
};

/// What a solved wall does to virtual skins.
struct StageSkins {
  int count = 0;
  double weight = 0;  ///< that Q was solved with
  SkinDifferences before, after;
  std::vector<SkinTradeOff> tradeOffs;
};

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
  std::optional<StageSkins> skins;           ///< where the stage is given as spectra
  Eigen::Vector3d whiteRgb{1, 1, 1};         ///< what counted as white in the differences
  std::optional<double> spectralSimilarity;  ///< SSI of the wall's white drive to the target, where spectra are known
  std::optional<WallIntervals> intervals;    ///< 95 % of the solution, where something was captured
  NoiseSource noise;                         ///< that they are of
  std::vector<std::string> notes;            ///< of the input, and what is out of reach and why
};

/// @throws spectral::InputError, naming the stage file: captures that show a mistake, and as solveWall
StageResult solveStage(const StageDescription& description, StageCapture capture, const SolveChoices& choices = {});

}  // namespace metamer::stage
