// SPDX-License-Identifier: Apache-2.0
#include "metamer/stage/stage_result.h"

#include <algorithm>
#include <array>
#include <utility>

#include "metamer/spectral/formatted.h"
#include "metamer/spectral/input_error.h"
#include "metamer/spectral/spectral_similarity_index.h"
#include "metamer/spectral/text.h"
#include "metamer/stage/capture_faults.h"
#include "metamer/stage/fixture.h"

namespace metamer::stage {
namespace {

using spectral::formatted;
using spectral::InputError;

constexpr std::array<const char*, 3> kChannels = {"red", "green", "blue"};
/// A drive below this is below zero, not rounding.
constexpr double kNegativeDrive = -1e-9;
constexpr std::size_t kMostNamed = 6;
/// Of captures that say nothing of their own.
constexpr double kAssumedNoise = 0.01;
/// Patches times samples: about a second.
constexpr Eigen::Index kMostPatchSamples = 1'000'000;
constexpr Eigen::Index kFewestSamples = 50;

std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t i = 0; i < names.size() && i < kMostNamed; ++i) {
    text += (i == 0 ? "" : ", ") + names[i];
  }
  return names.size() > kMostNamed ? text + " and " + std::to_string(names.size() - kMostNamed) + " more" : text;
}

WallOptions optionsOf(const StageDescription& description, const StageCapture& capture) {
  WallOptions options;
  options.heldPatch = description.preserveWhite ? capture.whitePatch : -1;
  options.largestCondition = description.largestCondition.value_or(kDefaultLargestCondition);
  options.patchWeights = Eigen::VectorXd::Ones(capture.wall.target.cols());
  for (const int patch : capture.skinPatches) {
    options.patchWeights[patch] = description.skinWeight;
  }
  options.skins = capture.skins;
  options.skinWeight = description.skinPriority;
  if (options.skinWeight > 0 && !options.skins) {
    throw InputError("", "q.skin_priority", spectral::shortestNumber(options.skinWeight),
                     "needs the stage's spectra (key 'spectra'): a chart alone does not tell what skin does");
  }
  if (!(options.patchWeights.maxCoeff() > 0)) {
    throw InputError("", "q.skin_weight", "0", "leaves no patch with a weight");
  }
  return options;
}

/// Of the wall's mixed light to the target's; nothing where the wall is dark.
std::optional<double> similarityOf(const CaptureSpectra& spectra, const Eigen::Vector3d& drive) {
  spectral::DomainSamples mixed = spectral::DomainSamples::Zero();
  for (std::size_t k = 0; k < 3; ++k) {
    mixed += drive[static_cast<Eigen::Index>(k)] * spectra.emitters[k];
  }
  if (!(mixed.maxCoeff() > 0)) {
    return std::nullopt;
  }
  return spectral::spectralSimilarityIndex(mixedLight(mixed), spectra.target);
}

/// A capture that shows a mistake is refused, or noted.
void judgeCapture(const StageDescription& description, bool asCaptured, StageCapture& capture) {
  if (capture.spectra) {
    return;
  }
  const auto faults = captureFaults(capture.wall, capture.expectation, capture.whitePatch);
  if (!faults.empty() && !asCaptured) {
    const std::size_t others = faults.size() - 1;
    std::string more;
    for (std::size_t i = 1; i < faults.size() && i <= 2; ++i) {
      more += (i == 1 ? "; so: " : ", ") + faults[i].field + (faults[i].value.empty() ? "" : " " + faults[i].value);
    }
    if (others > 2) {
      more += formatted(" and %zu more", others - 2);
    }
    throw InputError(description.where, faults.front().field, faults.front().value, faults.front().remedy + more);
  }
  for (const CaptureFault& fault : faults) {
    capture.notes.push_back("as captured: " + fault.field + (fault.value.empty() ? "" : " '" + fault.value + "'") +
                            " " + fault.remedy);
  }
}

NoiseSource noiseOf(const StageDescription& description, const StageCapture& capture) {
  if (description.noise) {
    return {*description.noise, "stated"};
  }
  if (capture.expectation) {
    const WallCapture& wall = capture.wall;
    return {{estimatedNoise(*capture.expectation, {wall.charts[0], wall.charts[1], wall.charts[2], wall.target}), 0},
            "estimated from the charts"};
  }
  return {{kAssumedNoise, 0}, "assumed"};
}

/// Intervals of the solution; where the file states no bound of N, it is chosen from them and the wall solved with it.
void addIntervals(const StageDescription& description, const SolveChoices& choices, WallOptions walls,
                  StageResult& result) {
  const StageCapture& capture = result.capture;
  if (choices.samples == 0 || (capture.spectra && !description.noise)) {
    return;
  }
  result.noise = noiseOf(description, capture);
  IntervalOptions options;
  options.noise = result.noise.noise;
  options.samples = static_cast<int>(std::min<Eigen::Index>(
      choices.samples, std::max(kFewestSamples, kMostPatchSamples / capture.wall.target.cols())));
  options.seed = choices.seed;
  options.choosesBound = !description.largestCondition;
  options.whitePatch = capture.whiteIsFromTarget ? capture.whitePatch : -1;
  options.whiteReflectance = description.whiteReflectance;
  options.xyzFromCamera = capture.xyzFromCamera;
  options.whiteRgb = result.whiteRgb;
  options.exposurePatch = capture.whitePatch;
  options.runAll = choices.runAll;
  try {
    result.intervals = wallIntervals(capture.wall, walls, options);
  } catch (const InputError& error) {
    result.notes.push_back(std::string("no intervals: with its noise the capture cannot be solved every time: ") +
                           error.what());
    return;
  }
  if (result.intervals->boundIsChosen) {
    walls.largestCondition = result.intervals->largestCondition;
    result.solution = solveWall(capture.wall, walls);
  }
}

/// Of skins, as of the chart.
StageSkins skinsOf(const StageResult& result, WallOptions options) {
  const Eigen::Matrix3Xd& target = options.skins->target;
  const StageCapture& capture = result.capture;
  const auto differences = [&](const Eigen::Matrix3Xd& skins) {
    return skinDifferencesOf(chartDifferences(skins, target, capture.xyzFromCamera, result.whiteRgb));
  };
  StageSkins skins;
  skins.count = static_cast<int>(target.cols());
  skins.weight = options.skinWeight;
  skins.before = differences(result.exposure * result.solution.predictedSkins);
  skins.after = differences(result.solution.correctedSkins);
  for (const double weight : skinTradeOffWeights(options.skinWeight)) {
    options.skinWeight = weight;
    const WallSolution solution = solveWall(capture.wall, options);
    const auto chart =
        chartDifferences(solution.corrected, capture.wall.target, capture.xyzFromCamera, result.whiteRgb);
    skins.tradeOffs.push_back({weight, summaryOf(chart).mean, differences(solution.correctedSkins)});
  }
  return skins;
}

/// What the wall cannot do, and why.
void addReachNotes(StageResult& result) {
  const WallSolution& solution = result.solution;
  for (std::size_t k = 0; k < 3; ++k) {
    const double asked = solution.environmentDriveAsked[static_cast<Eigen::Index>(k)];
    if (asked < kNegativeDrive) {
      result.notes.push_back(
          formatted("out of reach: the environment's white asks %.4g of %s, less than none; its colour "
                    "lies outside the wall's gamut, and 0 is used",
                    asked, kChannels[k]));
    }
  }
  std::vector<std::string> dark;
  for (Eigen::Index i = 0; i < result.capture.wall.target.cols(); ++i) {
    const Eigen::Vector3d drive =
        solution.frustumFromContent * result.capture.wall.target.col(i) + solution.frustumOffset;
    if (drive.minCoeff() < kNegativeDrive) {
      dark.push_back(result.capture.wall.patchNames[static_cast<std::size_t>(i)]);
    }
  }
  if (!dark.empty()) {
    result.notes.push_back("out of reach: shown in frustum, the target chart's " + listed(dark) +
                           " ask drives below 0, which are cut: too saturated after Q's inverse, or darker than the "
                           "black level");
  }
  if (solution.chartRank < 3) {
    result.notes.push_back(
        formatted("the patches give only %d independent colours of 3: Q is the best fit nearest to the "
                  "identity; photograph more patches",
                  solution.chartRank));
  }
  if (solution.bounded) {
    result.notes.push_back(
        "Q is nearly of rank one (the target light is close to one wavelength): N is bounded by "
        "q.max_condition" +
        std::string(result.intervals && result.intervals->boundIsChosen
                        ? formatted(" %g, chosen from the noise", result.intervals->largestCondition)
                        : "") +
        ", and in-frustum colours lose saturation; see the trade-off");
  }
}

}  // namespace

StageResult solveStage(const StageDescription& description, StageCapture capture, const SolveChoices& choices) {
  StageResult result;
  result.name = description.name;
  result.capture = std::move(capture);
  judgeCapture(description, choices.asCaptured, result.capture);
  WallOptions walls;
  try {
    walls = optionsOf(description, result.capture);
    result.solution = solveWall(result.capture.wall, walls);
  } catch (const InputError& error) {
    throw InputError(description.where, "", "", error.what());
  }
  const WallSolution& solution = result.solution;
  const Eigen::Matrix3Xd& target = result.capture.wall.target;
  const int white = result.capture.whitePatch;
  Eigen::Vector3d whiteRgb = result.capture.wall.environmentWhite;
  if (white >= 0) {
    whiteRgb = target.col(white);
    const double predictedGreen = solution.predicted(1, white);
    result.exposure = predictedGreen > 0 && target(1, white) > 0 ? target(1, white) / predictedGreen : 1;
  }
  result.whiteRgb = whiteRgb;
  if (result.capture.spectra) {
    result.spectralSimilarity = similarityOf(*result.capture.spectra, solution.environmentDrive);
  }
  result.differencesBefore =
      chartDifferences(result.exposure * solution.predicted, target, result.capture.xyzFromCamera, whiteRgb);
  result.differencesAfter = chartDifferences(solution.corrected, target, result.capture.xyzFromCamera, whiteRgb);
  result.before = summaryOf(result.differencesBefore);
  result.after = summaryOf(result.differencesAfter);
  result.skinBefore = summaryOf(result.differencesBefore, result.capture.skinPatches);
  result.skinAfter = summaryOf(result.differencesAfter, result.capture.skinPatches);
  if (walls.skins) {
    result.skins = skinsOf(result, walls);
  }
  result.notes = result.capture.notes;
  addIntervals(description, choices, walls, result);
  addReachNotes(result);
  return result;
}

}  // namespace metamer::stage
