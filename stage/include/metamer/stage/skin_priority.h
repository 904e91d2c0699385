// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <vector>

#include "metamer/spectral/data_library.h"
#include "metamer/spectral/spectrum.h"

namespace metamer::stage {

/// Virtual skins that stand for faces beside a chart: enough that another 800 differ by less than 0.02 CIEDE2000 in
/// their mean.
inline constexpr int kVirtualSkins = 200;
/// What each of them counts as, a patch of the chart being 1, where --priority skin says no more. Under tungsten,
/// daylight and white LEDs an RGB wall then has skin within 0.6 CIEDE2000, and the chart has lost 1.1 at most.
inline constexpr double kDefaultSkinWeight = 6;
inline constexpr double kLargestSkinWeight = 1e6;
/// Weights at which trade-offs are shown, beside the one asked for.
inline constexpr std::array<double, 6> kSkinTradeOffWeights = {0, 0.04, 0.2, 1, 6, 20};

/// The first kVirtualSkins of the data's virtual skins.
/// @throws spectral::InputError where the library has none
std::vector<spectral::Spectrum> virtualSkins(const spectral::DataLibrary& library);

/// "skin" or "skin:WEIGHT", 0 ... kLargestSkinWeight. @throws spectral::InputError for anything else
double skinWeightFrom(const std::string& priority);

/// How skins differ: CIEDE2000.
struct SkinDifferences {
  double mean = 0;
  double deviation = 0;  ///< standard deviation among skins
  double max = 0;
};
SkinDifferences skinDifferencesOf(const std::vector<double>& differences);

/// What a weight of skin costs a chart and buys for skin.
struct SkinTradeOff {
  double weight = 0;
  double chartMean = 0;  ///< CIEDE2000
  SkinDifferences skin;
};

/// kSkinTradeOffWeights with another among them, rising.
std::vector<double> skinTradeOffWeights(double weight);

}  // namespace metamer::stage
