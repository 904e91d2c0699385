// SPDX-License-Identifier: Apache-2.0
#include "stage/stage_report.h"

#include <array>

#include "metamer/spectral/formatted.h"
#include "stage/eotf_words.h"
#include "stage/skin_report.h"

namespace metamer::lutgen {
namespace {

std::string matrixRows(const Eigen::Matrix3d& matrix) {
  std::string text;
  for (Eigen::Index row = 0; row < 3; ++row) {
    text += spectral::formatted("    %12.6f %12.6f %12.6f\n", matrix(row, 0), matrix(row, 1), matrix(row, 2));
  }
  return text;
}

Json endsToJson(const stage::Interval<Eigen::Matrix3d>& interval) {
  return {{"low", rowsToJson(interval.low)}, {"high", rowsToJson(interval.high)}};
}

Json endsToJson(const stage::Interval<double>& interval) {
  return Json::array({numberToJson(interval.low), numberToJson(interval.high)});
}

Json intervalsToJson(const stage::StageResult& result) {
  const stage::WallIntervals& intervals = *result.intervals;
  return {{"confidence", 0.95},
          {"noise", {{"relative", result.noise.noise.relative}, {"floor", result.noise.noise.floor}}},
          {"noise_is", result.noise.words},
          {"samples", intervals.samples},
          {"M", endsToJson(intervals.wallFromContent)},
          {"Q", endsToJson(intervals.correctedFromCamera)},
          {"N", endsToJson(intervals.frustumFromContent)},
          {"environment_drive",
           {{"low", toJson(intervals.environmentDrive.low)}, {"high", toJson(intervals.environmentDrive.high)}}},
          {"dE_before_mean", endsToJson(intervals.meanBefore)},
          {"dE_after_mean", endsToJson(intervals.meanAfter)},
          {"dE_after_max", endsToJson(intervals.maxAfter)},
          {"max_condition", numberToJson(intervals.largestCondition)},
          {"in_frustum_error", numberToJson(intervals.frustumError)}};
}

/// Half the widest interval of a matrix over its largest entry.
double widthOf(const stage::Interval<Eigen::Matrix3d>& interval) {
  const Eigen::Matrix3d middle = (interval.high + interval.low) / 2;
  return (interval.high - interval.low).maxCoeff() / 2 / middle.cwiseAbs().maxCoeff();
}

std::string intervalsInWords(const stage::StageResult& result) {
  const stage::WallIntervals& intervals = *result.intervals;
  std::string text = spectral::formatted(
      "95 %% intervals of %d draws of noise (%.2g %%, %s): Q +-%.1f %%, N +-%.1f %% of their largest entries; "
      "CIEDE2000 mean %.2f to %.2f with M alone, %.2f to %.2f with M and Q; in-frustum error %.2g",
      intervals.samples, 100 * result.noise.noise.relative, result.noise.words.c_str(),
      100 * widthOf(intervals.correctedFromCamera), 100 * widthOf(intervals.frustumFromContent),
      intervals.meanBefore.low, intervals.meanBefore.high, intervals.meanAfter.low, intervals.meanAfter.high,
      intervals.frustumError);
  return intervals.boundIsChosen
             ? text + spectral::formatted(", least with N bounded at %g", intervals.largestCondition)
             : text;
}

/// Rows of a matrix with the half widths of their intervals.
std::string matrixRows(const Eigen::Matrix3d& matrix, const stage::Interval<Eigen::Matrix3d>& interval) {
  std::string text;
  for (Eigen::Index row = 0; row < 3; ++row) {
    text += "   ";
    for (Eigen::Index column = 0; column < 3; ++column) {
      text += spectral::formatted(" %10.4f [%.4f, %.4f]", matrix(row, column), interval.low(row, column),
                                  interval.high(row, column));
    }
    text += "\n";
  }
  return text;
}

constexpr std::array<const char*, 3> kChannels = {"red", "green", "blue"};

/// What is sent for the environment's white.
Eigen::Vector3d environmentSignal(const stage::StageResult& result) {
  Eigen::Vector3d signal;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto channel = static_cast<Eigen::Index>(k);
    signal[channel] = (*result.capture.eotf)[k].driveFor(result.solution.environmentDrive[channel]);
  }
  return signal;
}

/// A line a channel, and what is sent for the environment's white.
std::string eotfInWords(const stage::StageResult& result, const char* before) {
  std::string text;
  for (std::size_t k = 0; k < 3; ++k) {
    text += spectral::formatted("%sEOTF of %s: %s\n", before, kChannels[k], textOf((*result.capture.eotf)[k]).c_str());
  }
  const Eigen::Vector3d signal = environmentSignal(result);
  return text + spectral::formatted("%sthe environment's white is sent as %.4f, %.4f, %.4f of full\n", before,
                                    signal[0], signal[1], signal[2]);
}

/// A patch's name cannot break the table.
std::string cell(const std::string& name) {
  std::string text;
  for (const char c : name) {
    text += c == '|' ? std::string("\\|") : std::string(1, c);
  }
  return text;
}

}  // namespace

Json toJson(const stage::StageResult& result) {
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
  if (result.capture.eotf) {
    for (std::size_t k = 0; k < 3; ++k) {
      json["eotf"][kChannels[k]] = toJson((*result.capture.eotf)[k]);
    }
    json["environment_signal"] = toJson(environmentSignal(result));
  }
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
  if (result.intervals) {
    json["intervals"] = intervalsToJson(result);
  }
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
  if (result.skins) {
    json["virtual_skin"] = {{"count", result.skins->count},
                            {"weight", result.skins->weight},
                            {"dE_before", toJson(result.skins->before)},
                            {"dE_after", toJson(result.skins->after)},
                            {"trade_off", toJson(result.skins->tradeOffs)}};
  }
  json["excluded"] = Json::array();
  for (const stage::ExcludedPatch& patch : result.capture.excluded) {
    json["excluded"].push_back({{"name", patch.name}, {"reason", patch.reason}});
  }
  json["notes"] = result.notes;
  return json;
}

std::string summaryOf(const stage::StageResult& result) {
  const stage::WallSolution& solution = result.solution;
  std::string text =
      spectral::formatted("%zu patches, beta %.4f, condition numbers: primaries %.3g, chart %.3g, Q %.3g\n",
                          result.capture.wall.patchNames.size(), result.capture.wall.beta, solution.wallCondition,
                          solution.chartCondition, solution.correctionCondition);
  text += spectral::formatted("CIEDE2000, mean and max: M alone %.2f %.2f, M and Q %.2f %.2f\n", result.before.mean,
                              result.before.max, result.after.mean, result.after.max);
  if (!result.capture.skinPatches.empty()) {
    text += spectral::formatted("skin patches: M alone %.2f %.2f, M and Q %.2f %.2f\n", result.skinBefore.mean,
                                result.skinBefore.max, result.skinAfter.mean, result.skinAfter.max);
  }
  if (result.capture.eotf) {
    text += eotfInWords(result, "");
  }
  if (result.skins) {
    text += spectral::formatted("%d virtual skins: M alone %s; M and Q %s\n", result.skins->count,
                                textOf(result.skins->before).c_str(), textOf(result.skins->after).c_str());
    text += curveOf(result.skins->tradeOffs, result.skins->weight);
  }
  if (result.intervals) {
    text += intervalsInWords(result) + "\n";
  }
  if (!solution.tradeOffs.empty()) {
    text += "N, bounded at a condition number of Q: its gain over M, and the error of in-frustum colours\n";
    for (const stage::WallTradeOff& trade : solution.tradeOffs) {
      text += spectral::formatted("  %8.3g  gain %8.3g  error %.3g\n", trade.conditionLimit, trade.gain,
                                  trade.frustumError);
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

std::string reportOf(const stage::StageResult& result, const std::string& figure) {
  const stage::WallSolution& solution = result.solution;
  std::string text = "# LED stage: " + result.name + "\n\n";
  text += spectral::formatted(
      "Colour differences are CIEDE2000; the camera's RGB is %s. Before: M alone, exposed to the target's "
      "white. After: M, then Q.\n\n",
      result.capture.colourSpace.c_str());
  text += "| patches | before, mean | before, max | after, mean | after, max |\n| --- | --- | --- | --- | --- |\n";
  text += spectral::formatted("| all %zu | %.2f | %.2f | %.2f | %.2f |\n", result.capture.wall.patchNames.size(),
                              result.before.mean, result.before.max, result.after.mean, result.after.max);
  if (!result.capture.skinPatches.empty()) {
    text +=
        spectral::formatted("| skin, %zu | %.2f | %.2f | %.2f | %.2f |\n", result.capture.skinPatches.size(),
                            result.skinBefore.mean, result.skinBefore.max, result.skinAfter.mean, result.skinAfter.max);
  }
  if (result.skins) {
    text += spectral::formatted("\n%d virtual skins: before %s; after %s.\n", result.skins->count,
                                textOf(result.skins->before).c_str(), textOf(result.skins->after).c_str());
    text += tableOf(result.skins->tradeOffs, result.skins->weight);
  }
  if (result.spectralSimilarity) {
    text += spectral::formatted("\nSpectral similarity index (SSI) of the wall's white to the target light: %.0f\n",
                                *result.spectralSimilarity);
  }
  if (!figure.empty()) {
    text += "\n![Charts as squares in squares](" + figure +
            ")\n\n*Ground: the target. Inner square: above, M alone; below, M and Q.*\n";
  }
  text += "\n## Matrices\n\nM, out of frustum:\n\n" + matrixRows(solution.wallFromContent) +
          "\nQ, after the camera:\n\n" + matrixRows(solution.correctedFromCamera) + "\nN, in frustum" +
          (solution.bounded ? " (bounded)" : "") + ":\n\n" + matrixRows(solution.frustumFromContent);
  text += spectral::formatted("\nBlack offset after N: %.6f, %.6f, %.6f. beta %.4f.\n\n", solution.frustumOffset[0],
                              solution.frustumOffset[1], solution.frustumOffset[2], result.capture.wall.beta);
  text += spectral::formatted("Condition numbers: primaries %.3g, chart %.3g, Q %.3g.\n", solution.wallCondition,
                              solution.chartCondition, solution.correctionCondition);
  if (result.capture.eotf) {
    text += "\n" + eotfInWords(result, "- ");
  }
  if (result.intervals) {
    text += "\n" + intervalsInWords(result) + ".\n\nQ with its intervals:\n\n" +
            matrixRows(solution.correctedFromCamera, result.intervals->correctedFromCamera) +
            "\nN with its intervals:\n\n" +
            matrixRows(solution.frustumFromContent, result.intervals->frustumFromContent);
  }
  if (!solution.tradeOffs.empty()) {
    text +=
        "\nN by the largest condition number that Q's inverse may have (`q.max_condition`):\n\n"
        "| limit | gain over M | in-frustum error |\n| --- | --- | --- |\n";
    for (const stage::WallTradeOff& trade : solution.tradeOffs) {
      text += spectral::formatted("| %.3g | %.3g | %.3g |\n", trade.conditionLimit, trade.gain, trade.frustumError);
    }
  }
  if (!result.notes.empty() || !result.capture.excluded.empty()) {
    text += "\n## Notes\n\n";
    for (const stage::ExcludedPatch& patch : result.capture.excluded) {
      text += "- excluded: " + patch.name + ": " + patch.reason + "\n";
    }
    for (const std::string& note : result.notes) {
      text += "- " + note + "\n";
    }
  }
  text += "\n## Patches\n\n| patch | before | after |\n| --- | --- | --- |\n";
  for (std::size_t i = 0; i < result.capture.wall.patchNames.size(); ++i) {
    text += spectral::formatted("| %s | %.2f | %.2f |\n", cell(result.capture.wall.patchNames[i]).c_str(),
                                result.differencesBefore[i], result.differencesAfter[i]);
  }
  return text;
}

}  // namespace metamer::lutgen
