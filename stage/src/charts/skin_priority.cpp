// SPDX-License-Identifier: Apache-2.0
#include "metamer/stage/skin_priority.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "metamer/spectral/input_error.h"

namespace metamer::stage {
namespace {

constexpr const char* kTable = "virtual skins";
constexpr const char* kForm = "write skin or skin:WEIGHT, the weight of each virtual skin beside a patch's 1, 0 to 1e6";

}  // namespace

std::vector<spectral::Spectrum> virtualSkins(const spectral::DataLibrary& library) {
  std::vector<spectral::Spectrum> skins = library.reflectances(kTable).samples;
  if (skins.size() > kVirtualSkins) {
    skins.erase(skins.begin() + kVirtualSkins, skins.end());
  }
  return skins;
}

double skinWeightFrom(const std::string& priority) {
  const std::string what = "skin";
  if (priority == what) {
    return kDefaultSkinWeight;
  }
  double weight = -1;
  if (priority.rfind(what + ":", 0) == 0) {
    const char* const begin = priority.data() + what.size() + 1;
    const char* const end = priority.data() + priority.size();
    const auto read = std::from_chars(begin, end, weight);
    if (read.ec != std::errc() || read.ptr != end) {
      weight = -1;
    }
  }
  // Written so that NaN is refused.
  if (!(weight >= 0 && weight <= kLargestSkinWeight)) {
    throw spectral::InputError("--priority", "priority", priority, kForm);
  }
  return weight;
}

SkinDifferences skinDifferencesOf(const std::vector<double>& differences) {
  SkinDifferences result;
  const double share = 1.0 / static_cast<double>(std::max<std::size_t>(1, differences.size()));
  for (const double difference : differences) {
    result.mean += share * difference;
    result.max = std::max(result.max, difference);
  }
  double variance = 0;
  for (const double difference : differences) {
    variance += share * (difference - result.mean) * (difference - result.mean);
  }
  result.deviation = std::sqrt(variance);
  return result;
}

std::vector<double> skinTradeOffWeights(double weight) {
  std::vector<double> weights(kSkinTradeOffWeights.begin(), kSkinTradeOffWeights.end());
  weights.push_back(weight);
  std::sort(weights.begin(), weights.end());
  weights.erase(std::unique(weights.begin(), weights.end()), weights.end());
  return weights;
}

}  // namespace metamer::stage
