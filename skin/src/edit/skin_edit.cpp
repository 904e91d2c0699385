// SPDX-License-Identifier: Apache-2.0
#include "metamer/skin/skin_edit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "metamer/spectral/argument_checks.h"
#include "metamer/spectral/input_error.h"

namespace metamer::skin {
namespace {

constexpr std::array<const char*, 5> kNames = {"melanin", "blood", "thickness", "eumelanin", "deoxyhaemoglobin"};
constexpr std::array<float, 5> kLowest = {0, 0, kThinnestEpidermisUm, 0, 0};
constexpr std::array<float, 5> kHighest = {1, 1, kThickestEpidermisUm, 1, 1};

std::size_t indexOf(SkinQuantity quantity) {
  return static_cast<std::size_t>(quantity);
}

void requireMatte(std::span<const SkinPixel> pixels, Matte matte) {
  if (!matte.empty()) {
    spectral::requireAsMany("matte", static_cast<std::int64_t>(matte.size()), "pixels",
                            static_cast<std::int64_t>(pixels.size()));
  }
}

float shareAt(Matte matte, std::size_t pixel) {
  if (matte.empty()) {
    return 1;
  }
  const float share = matte[pixel];
  return std::isnan(share) ? 0 : std::clamp(share, 0.0F, 1.0F);
}

/// Moves a quantity to what `edited` makes of it, as far as the matte says.
template <typename Edit>
void change(std::span<SkinPixel> pixels, SkinQuantity quantity, Matte matte, const Edit& edited) {
  const std::size_t index = indexOf(quantity);
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const float share = shareAt(matte, i);
    float& value = pixels[i].skin[index];
    if (share > 0) {
      const float wanted = std::clamp(static_cast<float>(edited(value, i)), kLowest[index], kHighest[index]);
      value = share < 1 ? value + share * (wanted - value) : wanted;
    }
  }
}

void scale(std::span<SkinPixel> pixels, SkinQuantity quantity, double factor, Matte matte) {
  change(pixels, quantity, matte, [&](float value, std::size_t) { return value * factor; });
}

/// The Gaussian's weights at 0, 1, 2, ... pixels.
std::vector<double> gaussian(double radius) {
  const int reach = std::max(1, static_cast<int>(std::ceil(3 * radius)));
  std::vector<double> weights;
  for (int i = 0; i <= reach; ++i) {
    weights.push_back(std::exp(-0.5 * (i / radius) * (i / radius)));
  }
  return weights;
}

/// Smooths lines of `count` values, `stride` apart, that begin at `first`.
void smoothLine(std::vector<float>& values, std::size_t first, std::ptrdiff_t count, std::size_t stride,
                const std::vector<double>& weights) {
  const auto reach = static_cast<std::ptrdiff_t>(weights.size()) - 1;
  std::vector<float> smooth(static_cast<std::size_t>(count));
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    double sum = 0;
    double whole = 0;
    for (std::ptrdiff_t j = std::max<std::ptrdiff_t>(0, i - reach); j <= std::min(count - 1, i + reach); ++j) {
      const double weight = weights[static_cast<std::size_t>(std::abs(i - j))];
      sum += weight * static_cast<double>(values[first + static_cast<std::size_t>(j) * stride]);
      whole += weight;
    }
    smooth[static_cast<std::size_t>(i)] = static_cast<float>(sum / whole);
  }
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    values[first + static_cast<std::size_t>(i) * stride] = smooth[static_cast<std::size_t>(i)];
  }
}

}  // namespace

SkinQuantity skinQuantityFromName(const std::string& name) {
  const auto found = std::find(kNames.begin(), kNames.end(), name);
  if (found == kNames.end()) {
    throw spectral::InputError("", "quantity", name,
                               "must be melanin, blood, thickness, eumelanin or deoxyhaemoglobin");
  }
  return static_cast<SkinQuantity>(found - kNames.begin());
}

void multiplySkin(std::span<SkinPixel> pixels, SkinQuantity quantity, double factor, Matte matte) {
  spectral::requireWithin("factor", factor, 0, 1000);
  requireMatte(pixels, matte);
  scale(pixels, quantity, factor, matte);
}

void setSkin(std::span<SkinPixel> pixels, SkinQuantity quantity, double value, Matte matte) {
  const std::size_t index = indexOf(quantity);
  spectral::requireWithin(kNames[index], value, static_cast<double>(kLowest[index]),
                          static_cast<double>(kHighest[index]));
  requireMatte(pixels, matte);
  change(pixels, quantity, matte, [&](float, std::size_t) { return value; });
}

void smoothSkin(std::span<SkinPixel> pixels, SkinQuantity quantity, int width, double radiusPixels, Matte matte) {
  spectral::requireAbove("radius", radiusPixels, 0);
  spectral::requireWithin("radius", radiusPixels, 0, 1000);
  requireMatte(pixels, matte);
  if (width < 1 || pixels.size() % static_cast<std::size_t>(width) != 0) {
    throw spectral::InputError("", "width", std::to_string(width),
                               "must divide the pixels, " + std::to_string(pixels.size()));
  }
  const auto columns = static_cast<std::size_t>(width);
  const std::size_t rows = pixels.size() / columns;
  std::vector<float> values(pixels.size());
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    values[i] = pixels[i].skin[indexOf(quantity)];
  }
  const std::vector<double> weights = gaussian(radiusPixels);
  for (std::size_t row = 0; row < rows; ++row) {
    smoothLine(values, row * columns, static_cast<std::ptrdiff_t>(columns), 1, weights);
  }
  for (std::size_t column = 0; column < columns; ++column) {
    smoothLine(values, column, static_cast<std::ptrdiff_t>(rows), columns, weights);
  }
  change(pixels, quantity, matte, [&](float, std::size_t i) { return values[i]; });
}

void tanSkin(std::span<SkinPixel> pixels, double strength, Matte matte) {
  spectral::requireWithin("strength", strength, 0, 4);
  requireMatte(pixels, matte);
  scale(pixels, SkinQuantity::Melanin, 1 + strength, matte);
  change(pixels, SkinQuantity::Eumelanin, matte,
         [&](float value, std::size_t) { return value + strength / 4 * (1 - value); });
  scale(pixels, SkinQuantity::Thickness, 1 + strength / 10, matte);
}

void flushSkin(std::span<SkinPixel> pixels, double strength, Matte matte) {
  spectral::requireWithin("strength", strength, -0.9, 4);
  requireMatte(pixels, matte);
  scale(pixels, SkinQuantity::Blood, 1 + strength, matte);
  scale(pixels, SkinQuantity::Deoxyhaemoglobin, 1 / (1 + strength), matte);
}

void oxygenateSkin(std::span<SkinPixel> pixels, double strength, Matte matte) {
  spectral::requireWithin("strength", strength, -1, 1);
  requireMatte(pixels, matte);
  change(pixels, SkinQuantity::Deoxyhaemoglobin, matte, [&](float value, std::size_t) {
    return strength >= 0 ? value * (1 - strength) : value - strength * (1 - value);
  });
}

void thickenSkin(std::span<SkinPixel> pixels, double factor, Matte matte) {
  spectral::requireWithin("factor", factor, 0.01, 100);
  requireMatte(pixels, matte);
  scale(pixels, SkinQuantity::Thickness, factor, matte);
}

void bleachSkin(std::span<SkinPixel> pixels, double strength, Matte matte) {
  spectral::requireWithin("strength", strength, 0, 1);
  requireMatte(pixels, matte);
  scale(pixels, SkinQuantity::Melanin, 1 - strength, matte);
}

}  // namespace metamer::skin
