// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numeric>

#include "captures/chart_arrangement.h"
#include "metamer/spectral/formatted.h"
#include "metamer/stage/capture_faults.h"

namespace metamer::stage {
namespace {

using spectral::formatted;

/// Exponents of grey patches over their reflectance: 1 for linear values, 0.45 for those coded for a display.
constexpr double kLeastExponent = 0.75;
constexpr double kLargestExponent = 1.35;
/// A power of the reflectance must explain greys this much better than a veil does.
constexpr double kPowerIsBetter = 0.7;
constexpr std::size_t kFewestGreys = 4;
/// Without another arrangement that explains it, a chart of this misfit is another chart.
constexpr double kNoSuchChart = 0.22;
/// A part that all patches share, over white.
constexpr double kLargestVeil = 0.03;
constexpr double kVeilFloor = 0.05;
/// A patch's distance from what the others predict, over its value and the floor below.
constexpr double kOddPatch = 0.12;
constexpr double kOddOverOthers = 7;
constexpr double kOddFloor = 0.3;
constexpr double kSigmaFromMedian = 1.4826;
/// A patch is bright enough to be clipped from this share of its channel's largest value on.
constexpr double kMayClip = 0.6;
constexpr double kDarkChannel = 0.05;
constexpr int kMostOddPatches = 4;

Eigen::Index strongestOf(const Eigen::Matrix3Xd& rgb) {
  Eigen::Index strongest = 0;
  rgb.rowwise().sum().maxCoeff(&strongest);
  return strongest;
}

/// The exponent by which greys follow their reflectance, where a power explains them and a veil does not.
std::optional<double> codingOf(const ChartExpectation& expectation, const Eigen::Matrix3Xd& rgb) {
  const Eigen::VectorXd values = rgb(strongestOf(rgb), expectation.greys).transpose();
  const Eigen::VectorXd levels = expectation.level(expectation.greys);
  if (expectation.greys.size() < kFewestGreys || !(values.minCoeff() > 0) || !(levels.minCoeff() > 0)) {
    return std::nullopt;
  }
  const auto line = [](const Eigen::VectorXd& x, const Eigen::VectorXd& y, const Eigen::VectorXd& weights) {
    Eigen::MatrixX2d columns(x.size(), 2);
    columns << x, Eigen::VectorXd::Ones(x.size());
    const Eigen::Vector2d solved =
        (weights.asDiagonal() * columns).colPivHouseholderQr().solve(weights.cwiseProduct(y));
    return std::pair{solved[0], (weights.cwiseProduct(y - columns * solved)).norm()};
  };
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(values.size());
  const auto [exponent, powerMisfit] = line(levels.array().log(), values.array().log(), ones);
  const auto [slope, veilMisfit] = line(levels, values, values.cwiseInverse());
  const bool isLinear = exponent > kLeastExponent && exponent < kLargestExponent;
  return isLinear || powerMisfit > kPowerIsBetter * veilMisfit ? std::nullopt : std::optional<double>(exponent);
}

/// What all patches share, over the light of a perfect reflector.
double veilOf(const ChartExpectation& expectation, const Eigen::Matrix3Xd& rgb) {
  const Eigen::VectorXd values = rgb.row(strongestOf(rgb)).transpose();
  double white = values.maxCoeff();
  if (!expectation.greys.empty()) {
    const Eigen::VectorXd levels = expectation.level(expectation.greys);
    white = levels.dot(values(expectation.greys)) / levels.squaredNorm();
  }
  return white > 0 ? fitChannel(expectation.bands, values, kVeilFloor * white, true).veil / white : 0;
}

std::vector<Eigen::Index> without(const std::vector<Eigen::Index>& patches, Eigen::Index patch) {
  std::vector<Eigen::Index> others;
  std::copy_if(patches.begin(), patches.end(), std::back_inserter(others), [&](auto other) { return other != patch; });
  return others;
}

struct OddPatch {
  Eigen::Index patch = -1;
  double by = 0;  ///< relative to what the other patches predict
  bool isBright = false;
};

/// The patch farthest from what the others predict, and how far the middle one is.
struct Oddness {
  OddPatch farthest;
  double middle = 0;
};

Oddness oddnessOf(const ChartExpectation& expectation, const Eigen::Matrix3Xd& rgb,
                  const std::vector<Eigen::Index>& kept) {
  Oddness result;
  std::vector<double> distances;
  const double brightest = rgb.maxCoeff();
  for (Eigen::Index channel = 0; channel < 3; ++channel) {
    const Eigen::VectorXd values = rgb(channel, kept).transpose();
    const double top = values.maxCoeff();
    if (!(top > kDarkChannel * brightest)) {
      continue;
    }
    for (std::size_t i = 0; i < kept.size(); ++i) {
      const std::vector<Eigen::Index> others = without(kept, kept[i]);
      const ChannelFit fit =
          fitChannel(expectation.bands(others, Eigen::all), rgb(channel, others).transpose(), kOddFloor * top);
      const double predicted = std::max(0.0, expectation.bands.row(kept[i]).dot(fit.weights));
      const double value = values[static_cast<Eigen::Index>(i)];
      const double by = (value - predicted) / (predicted + kOddFloor * top);
      distances.push_back(std::abs(by));
      if (std::abs(by) > std::abs(result.farthest.by)) {
        result.farthest = {kept[i], by, value > kMayClip * top};
      }
    }
  }
  if (!distances.empty()) {
    const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
    std::nth_element(distances.begin(), middle, distances.end());
    result.middle = *middle;
  }
  return result;
}

/// The patch farthest from what the others of `kept` predict, where it is far; taken out of `kept`.
std::optional<OddPatch> takeOddPatch(const ChartExpectation& expectation, const Eigen::Matrix3Xd& rgb,
                                     std::vector<Eigen::Index>& kept) {
  const OddPatch odd = oddnessOf(expectation, rgb, kept).farthest;
  if (!(std::abs(odd.by) > kOddPatch)) {
    return std::nullopt;
  }
  // It pulls at what it helps to predict: the others are judged without it.
  const std::vector<Eigen::Index> others = without(kept, odd.patch);
  if (std::abs(odd.by) < kOddOverOthers * kSigmaFromMedian * oddnessOf(expectation, rgb, others).middle) {
    return std::nullopt;
  }
  kept = others;
  return odd;
}

CaptureFault oddFault(const OddPatch& odd, const std::string& name, const std::string& field) {
  const double percent = 100 * std::abs(odd.by);
  if (odd.by > 0) {
    return {field, name,
            formatted("is veiled: %.0f %% brighter than the other patches and its reflectance allow (a "
                      "highlight, light from the side?); shoot it anew, or put it under 'exclude'",
                      percent)};
  }
  if (odd.isBright) {
    return {field, name,
            formatted("is clipped: %.0f %% darker than the other patches and its reflectance allow; "
                      "expose less, say 'saturation', or put it under 'exclude'",
                      percent)};
  }
  return {field, name,
          formatted("is shaded: %.0f %% darker than the other patches and its reflectance allow; shoot it "
                    "anew, or put it under 'exclude'",
                    percent)};
}

}  // namespace

std::vector<CaptureFault> chartFaults(const ChartExpectation& expectation, const Eigen::Matrix3Xd& chart,
                                      const std::vector<std::string>& names, const std::string& field) {
  const Eigen::Matrix3Xd rgb = chart(Eigen::all, expectation.known);
  if (!(rgb.maxCoeff() > 0)) {
    return {};
  }
  if (const auto exponent = codingOf(expectation, rgb)) {
    return {{field, formatted("exponent %.2f", *exponent),
             "is not linear: its grey patches follow a power of their reflectance; undo the picture's coding (a "
             "display's, a log curve) first"}};
  }
  const Arrangement arrangement = arrangementOf(expectation, rgb);
  if (!arrangement.words.empty()) {
    return {{field, arrangement.words,
             formatted("is how its patches lie against their names (misfit %.0f %% as named, %.0f %% so); give the "
                       "corners from the first patch's on, along its row and round",
                       100 * arrangement.asNamed, 100 * arrangement.arranged)}};
  }
  std::vector<Eigen::Index> kept(expectation.known.size());
  std::iota(kept.begin(), kept.end(), Eigen::Index{0});
  if (arrangement.asNamed < kNoSuchChart) {
    const double veil = veilOf(expectation, rgb);
    const std::string percent = formatted("%.1f %% of white", 100 * std::abs(veil));
    if (veil > kLargestVeil) {
      return {{field, percent,
               "lies over all patches as a veil (flare, haze, light on the lens or from elsewhere); shade the lens, or "
               "subtract it"}};
    }
    if (veil < -kLargestVeil) {
      return {{field, percent,
               "is missing from all patches: too much black was subtracted; subtract what a covered lens shows"}};
    }
  }
  std::vector<CaptureFault> faults;
  while (faults.size() < kMostOddPatches && kept.size() > kFewestKnownPatches) {
    const auto odd = takeOddPatch(expectation, rgb, kept);
    if (!odd) {
      break;
    }
    const Eigen::Index place = expectation.known[static_cast<std::size_t>(odd->patch)];
    faults.push_back(oddFault(*odd, names[static_cast<std::size_t>(place)], field));
  }
  // A few odd patches make a large misfit too; the rest tells whether it is this chart.
  if (misfitOf(expectation.bands(kept, Eigen::all), rgb(Eigen::all, kept)) > kNoSuchChart) {
    return {{field, formatted("misfit %.0f %%", 100 * arrangement.asNamed),
             "does not look like the chart '" + expectation.set +
                 "' in any light; check names, order and corners, or name the right 'reflectances'"}};
  }
  return faults;
}

}  // namespace metamer::stage
