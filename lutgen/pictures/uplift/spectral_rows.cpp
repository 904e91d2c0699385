// SPDX-License-Identifier: Apache-2.0
#include "uplift/spectral_rows.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace metamer::lutgen {
namespace {

/// Pixels at a time: their spectra stay in the cache.
constexpr std::size_t kTogether = 64;
/// Beyond rounding.
constexpr double kSlack = 1e-4;

bool isPremultiplied(float alpha) {
  return alpha > 0 && alpha < 1;
}

}  // namespace

SpectralRows::SpectralRows(const spectral::Uplift& uplift, PixelFunction toRec709, const std::vector<int>& wavelengths)
    : m_uplift(uplift), m_toRec709(std::move(toRec709)) {
  const std::vector<double>& own = uplift.wavelengthsNm();
  for (const int nm : wavelengths) {
    const double inside = std::clamp<double>(nm, own.front(), own.back());
    const auto above = std::upper_bound(own.begin() + 1, own.end() - 1, inside);
    const auto index = static_cast<std::size_t>(above - own.begin()) - 1;
    m_places.push_back({index, static_cast<float>((inside - own[index]) / (own[index + 1] - own[index]))});
  }
}

void SpectralRows::count(const double* spectrum, Unphysical& unphysical) const {
  if (std::isnan(spectrum[0])) {
    ++unphysical.noNumbers;
    return;
  }
  std::uint64_t below = 0;
  std::uint64_t above = 0;
  for (std::size_t band = 0; band < m_uplift.wavelengthsNm().size(); ++band) {
    below |= static_cast<std::uint64_t>(spectrum[band] < -kSlack);
    above |= static_cast<std::uint64_t>(spectrum[band] > 1 + kSlack);
  }
  unphysical.below += below;
  unphysical.above += above;
}

void SpectralRows::spectra(std::span<const float> rgb, std::span<const float> alpha, std::span<float> spectra) {
  const std::size_t width = rgb.size() / 3;
  const std::size_t bands = m_uplift.wavelengthsNm().size();
  std::vector<float> rgba(4 * kTogether, 1.0F);
  std::vector<double> colours(3 * kTogether);
  std::vector<double> found(bands * kTogether);
  std::array<float, kTogether> scales{};
  Unphysical unphysical;
  for (std::size_t first = 0; first < width; first += kTogether) {
    const std::size_t count = std::min(kTogether, width - first);
    const auto scaleOf = [&](std::size_t i) {
      return !alpha.empty() && isPremultiplied(alpha[first + i]) ? alpha[first + i] : 1.0F;
    };
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        rgba[4 * i + k] = rgb[3 * (first + i) + k] / scaleOf(i);
      }
    }
    if (m_toRec709) {
      m_toRec709(std::span(rgba).first(4 * count));
    }
    for (std::size_t i = 0; i < count; ++i) {
      std::copy_n(&rgba[4 * i], 3, &colours[3 * i]);
    }
    m_uplift.spectra(std::span(colours).first(3 * count), std::span(found).first(bands * count));
    for (std::size_t i = 0; i < count; ++i) {
      this->count(&found[bands * i], unphysical);
      scales[i] = scaleOf(i);
    }
    for (std::size_t band = 0; band < m_places.size(); ++band) {
      const auto [index, share] = m_places[band];
      const double* spectrum = &found[index];
      float* const to = &spectra[band * width + first];
      for (std::size_t i = 0; i < count; ++i, spectrum += bands) {
        const auto here = static_cast<float>(spectrum[0]);
        const auto next = static_cast<float>(spectrum[1]);
        to[i] = (here + share * (next - here)) * scales[i];
      }
    }
  }
  m_below += unphysical.below;
  m_above += unphysical.above;
  m_noNumbers += unphysical.noNumbers;
}

}  // namespace metamer::lutgen
