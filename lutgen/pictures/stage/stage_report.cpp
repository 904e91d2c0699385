// SPDX-License-Identifier: Apache-2.0
#include "stage/stage_report.h"

#include <array>

#include "formatted.h"

namespace metamer::lutgen {
namespace {

std::string matrixRows(const Eigen::Matrix3d& matrix) {
  std::string text;
  for (Eigen::Index row = 0; row < 3; ++row) {
    text += formatted("    %12.6f %12.6f %12.6f\n", matrix(row, 0), matrix(row, 1), matrix(row, 2));
  }
  return text;
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

std::string reportOf(const StageResult& result, const std::string& figure) {
  const stage::WallSolution& solution = result.solution;
  std::string text = "# LED stage: " + result.name + "\n\n";
  text += formatted(
      "Colour differences are CIEDE2000; the camera's RGB is %s. Before: M alone, exposed to the target's "
      "white. After: M, then Q.\n\n",
      result.capture.colourSpace.c_str());
  text += "| patches | before, mean | before, max | after, mean | after, max |\n| --- | --- | --- | --- | --- |\n";
  text += formatted("| all %zu | %.2f | %.2f | %.2f | %.2f |\n", result.capture.wall.patchNames.size(),
                    result.before.mean, result.before.max, result.after.mean, result.after.max);
  if (!result.capture.skinPatches.empty()) {
    text += formatted("| skin, %zu | %.2f | %.2f | %.2f | %.2f |\n", result.capture.skinPatches.size(),
                      result.skinBefore.mean, result.skinBefore.max, result.skinAfter.mean, result.skinAfter.max);
  }
  if (result.spectralSimilarity) {
    text += formatted("\nSpectral similarity index (SSI) of the wall's white to the target light: %.0f\n",
                      *result.spectralSimilarity);
  }
  if (!figure.empty()) {
    text += "\n![Charts as squares in squares](" + figure +
            ")\n\n*Ground: the target. Inner square: above, M alone; below, M and Q.*\n";
  }
  text += "\n## Matrices\n\nM, out of frustum:\n\n" + matrixRows(solution.wallFromContent) +
          "\nQ, after the camera:\n\n" + matrixRows(solution.correctedFromCamera) + "\nN, in frustum" +
          (solution.bounded ? " (bounded)" : "") + ":\n\n" + matrixRows(solution.frustumFromContent);
  text += formatted("\nBlack offset after N: %.6f, %.6f, %.6f. beta %.4f.\n\n", solution.frustumOffset[0],
                    solution.frustumOffset[1], solution.frustumOffset[2], result.capture.wall.beta);
  text += formatted("Condition numbers: primaries %.3g, chart %.3g, Q %.3g.\n", solution.wallCondition,
                    solution.chartCondition, solution.correctionCondition);
  if (!solution.tradeOffs.empty()) {
    text +=
        "\nN by the largest condition number that Q's inverse may have (`q.max_condition`):\n\n"
        "| limit | gain over M | in-frustum error |\n| --- | --- | --- |\n";
    for (const stage::WallTradeOff& trade : solution.tradeOffs) {
      text += formatted("| %.3g | %.3g | %.3g |\n", trade.conditionLimit, trade.gain, trade.frustumError);
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
    text += formatted("| %s | %.2f | %.2f |\n", cell(result.capture.wall.patchNames[i]).c_str(),
                      result.differencesBefore[i], result.differencesAfter[i]);
  }
  return text;
}

}  // namespace metamer::lutgen
