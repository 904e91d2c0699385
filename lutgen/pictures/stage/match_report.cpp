// SPDX-License-Identifier: Apache-2.0
#include "stage/match_report.h"

#include "metamer/spectral/formatted.h"
#include "metamer/stage/chart_difference.h"
#include "stage/skin_report.h"
#include "stage_pictures/chart_figure.h"

namespace metamer::lutgen {
namespace {

/// Patches a row in a picture of the chart.
constexpr int kColumns = 6;

}  // namespace

Json toJson(const stage::MatchOutcome& outcome) {
  const std::vector<double> differences = differencesOf(outcome);
  const stage::DifferenceSummary summary = stage::summaryOf(differences);
  Json json;
  json["target"] = outcome.target;
  json["method"] = outcome.method;
  json["weights"] = outcome.weights.empty() ? Json(nullptr) : Json(outcome.weights);
  json["observer"] = outcome.observer;
  json["reflectances"] = outcome.reflectances;
  json["emitters"] = outcome.emitters;
  json["models"] = outcome.models;
  json["drives"] = toJson(outcome.match.drives);
  json["residual"] = numberToJson(outcome.match.relativeResidual);
  json["residual_norm"] = numberToJson(outcome.match.residualNorm);
  json["rank"] = outcome.match.rank;
  json["condition"] = numberToJson(outcome.match.condition);
  json["SSI"] = outcome.spectralSimilarity ? numberToJson(*outcome.spectralSimilarity) : Json(nullptr);
  json["dE"] = {{"mean", numberToJson(summary.mean)}, {"max", numberToJson(summary.max)}};
  json["patches"] = Json::array();
  for (std::size_t i = 0; i < differences.size(); ++i) {
    json["patches"].push_back({{"name", outcome.patches[i]}, {"dE", numberToJson(differences[i])}});
  }
  if (outcome.skins) {
    json["virtual_skin"] = {{"count", outcome.skins->count},
                            {"weight", outcome.skins->weight},
                            {"dE", toJson(outcome.skins->differences)},
                            {"trade_off", toJson(outcome.skins->tradeOffs)}};
  }
  json["excluded"] = Json::array();
  for (const stage::ExcludedPatch& patch : outcome.excluded) {
    json["excluded"].push_back({{"name", patch.name}, {"reason", patch.reason}});
  }
  json["notes"] = outcome.notes;
  return json;
}

std::string summaryOf(const stage::MatchOutcome& outcome) {
  std::string text;
  for (std::size_t i = 0; i < outcome.emitters.size(); ++i) {
    text += spectral::formatted("%-30s %.6g\n", outcome.emitters[i].c_str(),
                                outcome.match.drives[static_cast<Eigen::Index>(i)]);
  }
  const stage::DifferenceSummary summary = stage::summaryOf(differencesOf(outcome));
  text += spectral::formatted("residual %.6g, CIEDE2000 mean %.2f max %.2f\n", outcome.match.relativeResidual,
                              summary.mean, summary.max);
  if (outcome.skins) {
    text += std::to_string(outcome.skins->count) + " virtual skins: " + textOf(outcome.skins->differences) + "\n" +
            curveOf(outcome.skins->tradeOffs, outcome.skins->weight);
  }
  for (const stage::ExcludedPatch& patch : outcome.excluded) {
    text += "excluded: " + patch.name + ": " + patch.reason + "\n";
  }
  for (const std::string& note : outcome.notes) {
    text += "note: " + note + "\n";
  }
  return text;
}

std::string reportOf(const stage::MatchOutcome& outcome, const std::string& figure) {
  const std::vector<double> differences = differencesOf(outcome);
  const stage::DifferenceSummary summary = stage::summaryOf(differences);
  std::string text = "# " + outcome.target + " by " + std::to_string(outcome.emitters.size()) + " emitters\n\n";
  const std::string weights = outcome.weights.empty() ? "" : ", " + outcome.weights + " weights";
  text += spectral::formatted(
      "Method %s%s, observer %s, materials %s. Residual %.6g of the target, condition number %.3g.\n",
      outcome.method.c_str(), weights.c_str(), outcome.observer.c_str(), outcome.reflectances.c_str(),
      outcome.match.relativeResidual, outcome.match.condition);
  if (outcome.spectralSimilarity) {
    text += spectral::formatted("Spectral similarity index (SSI) %.0f.\n", *outcome.spectralSimilarity);
  }
  text += spectral::formatted("CIEDE2000: mean %.2f, max %.2f.\n\n| emitter | drive |\n| --- | --- |\n", summary.mean,
                              summary.max);
  for (std::size_t i = 0; i < outcome.emitters.size(); ++i) {
    text += spectral::formatted("| %s | %.6g |\n", outcome.emitters[i].c_str(),
                                outcome.match.drives[static_cast<Eigen::Index>(i)]);
  }
  if (outcome.skins) {
    text += "\n" + std::to_string(outcome.skins->count) + " virtual skins: " + textOf(outcome.skins->differences) +
            ".\n" + tableOf(outcome.skins->tradeOffs, outcome.skins->weight);
  }
  if (!figure.empty()) {
    text += "\n![Chart as squares in squares](" + figure + ")\n\n*Ground: the target. Inner square: the emitters.*\n";
  }
  text += "\n| patch | CIEDE2000 |\n| --- | --- |\n";
  for (std::size_t i = 0; i < differences.size(); ++i) {
    text += spectral::formatted("| %s | %.2f |\n", outcome.patches[i].c_str(), differences[i]);
  }
  if (!outcome.notes.empty() || !outcome.excluded.empty()) {
    text += "\n";
  }
  for (const stage::ExcludedPatch& patch : outcome.excluded) {
    text += "- excluded: " + patch.name + ": " + patch.reason + "\n";
  }
  for (const std::string& note : outcome.notes) {
    text += "- " + note + "\n";
  }
  return text;
}

void writeFigure(const stage::MatchOutcome& outcome, const spectral::DataLibrary& library,
                 const std::filesystem::path& file) {
  const auto display = library.colourSpace("Rec.709").linear;
  writeChartFigure({{outcome.wanted, outcome.made}}, kColumns,
                   displayFromCamera(outcome.xyzFromResponse, outcome.white, display.rgbFromXyz(), display.whiteXyz()),
                   file);
}

}  // namespace metamer::lutgen
