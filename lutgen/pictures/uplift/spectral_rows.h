// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "exr/exr_change.h"
#include "metamer/spectral/uplift.h"

namespace metamer::lutgen {

/// Colours of a picture, a row at a time, as their spectra. Safe on several threads.
class SpectralRows {
 public:
  /// @param uplift       of linear Rec.709
  /// @param toRec709     from the picture's linear space; empty: it is Rec.709
  /// @param wavelengths  nm, rising
  SpectralRows(const spectral::Uplift& uplift, PixelFunction toRec709, const std::vector<int>& wavelengths);

  /// @param rgb      linear in the picture's space, three numbers a pixel
  /// @param alpha    one a pixel, or empty: colours behind an alpha above 0 and below 1 are taken as premultiplied,
  ///                 and so are their spectra
  /// @param spectra  all pixels at the first wavelength, then at the next ...
  void spectra(std::span<const float> rgb, std::span<const float> alpha, std::span<float> spectra);

  /// Pixels so far whose spectrum is no reflectance: below 0 or above 1 somewhere, or not a number.
  struct Unphysical {
    std::uint64_t below = 0;
    std::uint64_t above = 0;
    std::uint64_t noNumbers = 0;
  };
  Unphysical unphysical() const { return {m_below, m_above, m_noNumbers}; }

 private:
  /// Where a wavelength lies on the uplift's: a share of the next value.
  struct Place {
    std::size_t index;
    float share;
  };

  void count(const double* spectrum, Unphysical& unphysical) const;

  const spectral::Uplift& m_uplift;
  PixelFunction m_toRec709;
  std::vector<Place> m_places;
  std::atomic<std::uint64_t> m_below{0};
  std::atomic<std::uint64_t> m_above{0};
  std::atomic<std::uint64_t> m_noNumbers{0};
};

}  // namespace metamer::lutgen
