// SPDX-License-Identifier: Apache-2.0
#include "stage/stage_result.h"

#include <array>

#include "formatted.h"
#include "metamer/spectral/input_error.h"
#include "metamer/spectral/spectral_similarity_index.h"
#include "stage/fixture.h"

namespace metamer::lutgen {
namespace {

using spectral::InputError;

constexpr std::array<const char*, 3> kChannels = {"red", "green", "blue"};
/// A drive below this is below zero, not rounding.
constexpr double kNegativeDrive = -1e-9;
constexpr std::size_t kMostNamed = 6;

std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t i = 0; i < names.size() && i < kMostNamed; ++i) {
    text += (i == 0 ? "" : ", ") + names[i];
  }
  return names.size() > kMostNamed ? text + " and " + std::to_string(names.size() - kMostNamed) + " more" : text;
}

stage::WallOptions optionsOf(const stage::StageDescription& stage, const StageCapture& capture) {
  stage::WallOptions options;
  options.heldPatch = stage.preserveWhite ? capture.whitePatch : -1;
  options.largestCondition = stage.largestCondition;
  options.patchWeights = Eigen::VectorXd::Ones(capture.wall.target.cols());
  for (const int patch : capture.skinPatches) {
    options.patchWeights[patch] = stage.skinWeight;
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
  return spectral::spectralSimilarityIndex(lightOf(mixed), spectra.target);
}

/// What the wall cannot do, and why.
void addReachNotes(StageResult& result) {
  const stage::WallSolution& solution = result.solution;
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
        "q.max_condition, and in-frustum colours lose saturation; see the trade-off");
  }
}

}  // namespace

StageResult solveStage(const stage::StageDescription& stage, const spectral::DataLibrary& library,
                       const std::string& checkPictures) {
  StageResult result;
  result.name = stage.name;
  result.capture = readCapture(stage, library, checkPictures);
  try {
    result.solution = stage::solveWall(result.capture.wall, optionsOf(stage, result.capture));
  } catch (const InputError& error) {
    throw InputError(stage.where, "", "", error.what());
  }
  const stage::WallSolution& solution = result.solution;
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
      stage::chartDifferences(result.exposure * solution.predicted, target, result.capture.xyzFromCamera, whiteRgb);
  result.differencesAfter = stage::chartDifferences(solution.corrected, target, result.capture.xyzFromCamera, whiteRgb);
  result.before = stage::summaryOf(result.differencesBefore);
  result.after = stage::summaryOf(result.differencesAfter);
  result.skinBefore = stage::summaryOf(result.differencesBefore, result.capture.skinPatches);
  result.skinAfter = stage::summaryOf(result.differencesAfter, result.capture.skinPatches);
  result.notes = result.capture.notes;
  addReachNotes(result);
  return result;
}

Json toJson(const StageResult& result) {
  const stage::WallSolution& solution = result.solution;
  Json json;
  json["metamer_stage"] = 1;
  json["name"] = result.name;
  json["M"] = rowsToJson(solution.wallFromContent);
  json["Q"] = rowsToJson(solution.correctedFromCamera);
  json["N"] = rowsToJson(solution.frustumFromContent);
  json["beta"] = result.capture.wall.beta;
  json["offset"] = toJson(solution.frustumOffset);
  json["primaries"] = rowsToJson(result.capture.wall.cameraFromWall);
  json["black_level"] = toJson(result.capture.wall.blackLevel);
  json["environment_white"] = toJson(result.capture.wall.environmentWhite);
  json["environment_drive"] = toJson(solution.environmentDrive);
  json["colour_space"] = result.capture.colourSpace;
  json["condition"] = {{"primaries", numberToJson(solution.wallCondition)},
                       {"chart", numberToJson(solution.chartCondition)},
                       {"Q", numberToJson(solution.correctionCondition)}};
  json["N_bounded"] = solution.bounded;
  json["N_trade_off"] = Json::array();
  for (const stage::WallTradeOff& trade : solution.tradeOffs) {
    json["N_trade_off"].push_back(
        {{"max_condition", trade.conditionLimit}, {"gain", trade.gain}, {"in_frustum_error", trade.frustumError}});
  }
  json["exposure_before"] = result.exposure;
  json["patches"] = Json::array();
  for (std::size_t i = 0; i < result.capture.wall.patchNames.size(); ++i) {
    const auto column = static_cast<Eigen::Index>(i);
    json["patches"].push_back({{"name", result.capture.wall.patchNames[i]},
                               {"predicted", toJson(solution.predicted.col(column))},
                               {"corrected", toJson(solution.corrected.col(column))},
                               {"target", toJson(result.capture.wall.target.col(column))},
                               {"dE_before", numberToJson(result.differencesBefore[i])},
                               {"dE_after", numberToJson(result.differencesAfter[i])}});
  }
  const auto summary = [](const stage::DifferenceSummary& differences) {
    return Json{{"mean", numberToJson(differences.mean)}, {"max", numberToJson(differences.max)}};
  };
  json["dE_before"] = summary(result.before);
  json["dE_after"] = summary(result.after);
  if (result.spectralSimilarity) {
    json["SSI"] = *result.spectralSimilarity;
  }
  if (!result.capture.skinPatches.empty()) {
    Json names = Json::array();
    for (const int patch : result.capture.skinPatches) {
      names.push_back(result.capture.wall.patchNames[static_cast<std::size_t>(patch)]);
    }
    json["skin"] = {
        {"patches", names}, {"dE_before", summary(result.skinBefore)}, {"dE_after", summary(result.skinAfter)}};
  }
  json["excluded"] = Json::array();
  for (const stage::ExcludedPatch& patch : result.capture.excluded) {
    json["excluded"].push_back({{"name", patch.name}, {"reason", patch.reason}});
  }
  json["notes"] = result.notes;
  return json;
}

std::string summaryOf(const StageResult& result) {
  const stage::WallSolution& solution = result.solution;
  std::string text = formatted("%zu patches, beta %.4f, condition numbers: primaries %.3g, chart %.3g, Q %.3g\n",
                               result.capture.wall.patchNames.size(), result.capture.wall.beta, solution.wallCondition,
                               solution.chartCondition, solution.correctionCondition);
  text += formatted("CIEDE2000, mean and max: M alone %.2f %.2f, M and Q %.2f %.2f\n", result.before.mean,
                    result.before.max, result.after.mean, result.after.max);
  if (!result.capture.skinPatches.empty()) {
    text += formatted("skin patches: M alone %.2f %.2f, M and Q %.2f %.2f\n", result.skinBefore.mean,
                      result.skinBefore.max, result.skinAfter.mean, result.skinAfter.max);
  }
  if (!solution.tradeOffs.empty()) {
    text += "N, bounded at a condition number of Q: its gain over M, and the error of in-frustum colours\n";
    for (const stage::WallTradeOff& trade : solution.tradeOffs) {
      text += formatted("  %8.3g  gain %8.3g  error %.3g\n", trade.conditionLimit, trade.gain, trade.frustumError);
    }
  }
  for (const stage::ExcludedPatch& patch : result.capture.excluded) {
    text += "excluded: " + patch.name + ": " + patch.reason + "\n";
  }
  for (const std::string& note : result.notes) {
    text += "note: " + note + "\n";
  }
  return text;
}

}  // namespace metamer::lutgen
