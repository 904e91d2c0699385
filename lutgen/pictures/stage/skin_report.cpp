// SPDX-License-Identifier: Apache-2.0
#include "stage/skin_report.h"

#include "metamer/spectral/formatted.h"

namespace metamer::lutgen {

Json toJson(const stage::SkinDifferences& differences) {
  return {{"mean", numberToJson(differences.mean)},
          {"deviation", numberToJson(differences.deviation)},
          {"max", numberToJson(differences.max)}};
}

Json toJson(const std::vector<stage::SkinTradeOff>& tradeOffs) {
  Json list = Json::array();
  for (const stage::SkinTradeOff& one : tradeOffs) {
    list.push_back({{"weight", one.weight}, {"chart_dE", numberToJson(one.chartMean)}, {"skin_dE", toJson(one.skin)}});
  }
  return list;
}

std::string textOf(const stage::SkinDifferences& differences) {
  return spectral::formatted("%.2f +- %.2f, at most %.2f", differences.mean, differences.deviation, differences.max);
}

std::string curveOf(const std::vector<stage::SkinTradeOff>& tradeOffs, double weight) {
  std::string text = tradeOffs.empty() ? "" : "mean CIEDE2000 of chart and skin, by --priority skin:WEIGHT\n";
  for (const stage::SkinTradeOff& one : tradeOffs) {
    text += spectral::formatted("  %8g  chart %6.2f  skin %6.2f%s\n", one.weight, one.chartMean, one.skin.mean,
                                one.weight == weight ? "  <" : "");
  }
  return text;
}

std::string tableOf(const std::vector<stage::SkinTradeOff>& tradeOffs, double weight) {
  if (tradeOffs.empty()) {
    return {};
  }
  std::string text =
      "\nBy the weight of skin (`--priority skin:WEIGHT`):\n\n| weight | chart, mean | skin |\n| --- | --- | --- |\n";
  for (const stage::SkinTradeOff& one : tradeOffs) {
    text += spectral::formatted(one.weight == weight ? "| **%g** | %.2f | %s |\n" : "| %g | %.2f | %s |\n", one.weight,
                                one.chartMean, textOf(one.skin).c_str());
  }
  return text;
}

}  // namespace metamer::lutgen
