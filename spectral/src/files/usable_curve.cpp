// SPDX-License-Identifier: Apache-2.0
#include "files/usable_curve.h"

#include <algorithm>
#include <cmath>

#include "metamer/spectral/input_error.h"
#include "metamer/spectral/text.h"

namespace metamer::spectral {
namespace {

/// Noise below zero goes to this part of the peak; more is another kind of data.
constexpr double kNoiseOfPeak = 0.05;
/// A lamp's floor was cut where at least so many values between others, and this part of them, are exactly 0.
constexpr std::size_t kFewestZeros = 20;
constexpr double kZerosPart = 0.1;

bool isOutside(double nm) {
  return nm < kDomainStartNm || nm > kDomainEndNm;
}

/// The column without flaws.
UsableCurve withoutFlaws(const SampledRows& rows, std::size_t column, SpectralQuantity quantity) {
  UsableCurve curve;
  const std::vector<double>& values = rows.columns[column];
  const auto isThere = [](double value) { return !std::isnan(value); };
  const auto firstThere =
      static_cast<std::size_t>(std::find_if(values.begin(), values.end(), isThere) - values.begin());
  const auto behindLast =
      static_cast<std::size_t>(values.rend() - std::find_if(values.rbegin(), values.rend(), isThere));
  for (std::size_t row = 0; row < values.size(); ++row) {
    const double nm = rows.wavelengthsNm[row];
    if (!std::isnan(values[row])) {
      curve.wavelengthsNm.push_back(nm);
      curve.values.push_back(values[row]);
      curve.rows.push_back(row);
      continue;
    }
    const auto flaw = rows.flaws.find({row, column});
    const std::string text = flaw == rows.flaws.end() ? "nan" : flaw->second;
    const bool endsCurve =
        text.empty() && quantity == SpectralQuantity::Sensitivity && (row < firstThere || row >= behindLast);
    if (!isOutside(nm) && !endsCurve) {
      requiredNumber(text, rows.rowWhere(row), "value");
    }
  }
  if (curve.values.size() < 2) {
    throw InputError(rows.where, rows.names[column], "",
                     "has fewer than two numbers; a spectrum needs at least two, and leave an empty column out");
  }
  return curve;
}

void findUsed(UsableCurve& curve) {
  const std::vector<double>& nm = curve.wavelengthsNm;
  const auto first = std::upper_bound(nm.begin(), nm.end(), static_cast<double>(kDomainStartNm));
  const auto last = std::lower_bound(nm.begin(), nm.end(), static_cast<double>(kDomainEndNm));
  curve.firstUsed = static_cast<std::size_t>(std::max(first - nm.begin() - 1, std::ptrdiff_t{0}));
  curve.lastUsed = std::min(static_cast<std::size_t>(last - nm.begin()), nm.size() - 1);
}

void cutNoise(UsableCurve& curve, const SampledRows& rows, SpectralQuantity quantity) {
  const auto used = [&](std::size_t i) { return i >= curve.firstUsed && i <= curve.lastUsed; };
  const auto begin = curve.values.begin();
  const double peak = *std::max_element(begin + static_cast<std::ptrdiff_t>(curve.firstUsed),
                                        begin + static_cast<std::ptrdiff_t>(curve.lastUsed) + 1);
  std::size_t count = 0;
  double lowest = 0;
  double lowestNm = 0;
  for (std::size_t i = 0; i < curve.values.size(); ++i) {
    double& value = curve.values[i];
    if (value >= 0) {
      continue;
    }
    if (used(i)) {
      if (value < -kNoiseOfPeak * peak) {
        throw InputError(rows.rowWhere(curve.rows[i]), quantityName(quantity), numberText(value),
                         "must not be negative; set measurement noise below zero to 0");
      }
      ++count;
      if (value < lowest) {
        lowest = value;
        lowestNm = curve.wavelengthsNm[i];
      }
    }
    value = 0;
  }
  if (count > 0) {
    curve.notes.push_back(std::to_string(count) + (count == 1 ? " value" : " values") +
                          " below zero set to 0, the lowest " + threeDigits(-100 * lowest / peak) +
                          " % of the peak below it, at " + numberText(lowestNm) + " nm");
  }
}

void noteCutFloor(UsableCurve& curve) {
  std::size_t first = curve.firstUsed;
  std::size_t last = curve.lastUsed;
  while (first < last && curve.values[first] == 0) {
    ++first;
  }
  while (last > first && curve.values[last] == 0) {
    --last;
  }
  const auto begin = curve.values.begin();
  const auto zeros = static_cast<std::size_t>(
      std::count(begin + static_cast<std::ptrdiff_t>(first), begin + static_cast<std::ptrdiff_t>(last) + 1, 0.0));
  const std::size_t count = last - first + 1;
  if (zeros >= kFewestZeros && static_cast<double>(zeros) >= kZerosPart * static_cast<double>(count)) {
    curve.notes.push_back(std::to_string(zeros) + " of its " + std::to_string(count) + " values from " +
                          numberText(curve.wavelengthsNm[first]) + " to " + numberText(curve.wavelengthsNm[last]) +
                          " nm are exactly 0: if the meter cut its noise floor, colours that hang on these wavelengths "
                          "are guesses; use an export without the cut");
  }
}

}  // namespace

UsableCurve usableCurve(const SampledRows& rows, std::size_t column, SpectralQuantity quantity) {
  UsableCurve curve = withoutFlaws(rows, column, quantity);
  findUsed(curve);
  if (quantity == SpectralQuantity::SpectralPowerDistribution) {
    noteCutFloor(curve);
  }
  if (quantity != SpectralQuantity::Sensitivity) {
    cutNoise(curve, rows, quantity);
  }
  return curve;
}

}  // namespace metamer::spectral
