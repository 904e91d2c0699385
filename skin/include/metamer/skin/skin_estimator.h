// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <span>
#include <vector>

#include "metamer/skin/skin_colours.h"
#include "metamer/skin/skin_pixel.h"
#include "metamer/skin/skin_view.h"

namespace metamer::skin {

/// What colour says about each parameter, and what is left to the prior, at the mean skin.
struct SkinIdentification {
  /// By coordinate: the share of the prior's variance that a colour known to one per cent takes away, 0 ... 1.
  std::array<double, 5> explained{};
  /// Correlation of melanin and blood once the colour is known, -1 ... 1: near either end one passes for the other.
  double melaninAgainstBlood = 0;
  /// Whether this view tells blood from melanin: it explains a half of both and they are not exchanged.
  bool separatesBloodFromMelanin = true;
};

/// Chromaticities that an estimator tells apart, (R - G) and (B - G) over the mean of the three; others count as the
/// nearest. So many knots lie evenly along each, first and last included.
struct SkinChromaticities {
  Eigen::Array2d low;
  Eigen::Array2d high;
  int knots = 0;
};

/// Colours to skins (sections 3.6 to 3.8): the most probable parameters under the prior (maximum a posteriori) by a
/// table over chromaticity and brightness, and the exact colour by a residual. Immutable, safe between threads.
///
/// Exposure: a colour brighter or darker than skin of its chromaticity can be is that skin times a gain, so that no
/// exposure leads out of the table. Colours that are no skin (blue, neon, negative) get the nearest skin of the table
/// and a large residual; pixels that are not finite, and black, the mean skin with a gain of 0 and themselves as
/// residual.
class SkinEstimator {
 public:
  /// Solves the table on `threads` threads (1 ... 256): some tenths of a second each.
  /// @throws spectral::InputError outside that range, and as SkinModel and SkinPrior
  SkinEstimator(const spectral::DataLibrary& library, const SkinView& view, int threads = 2);

  /// The skin of one pixel's linear RGB.
  SkinPixel estimate(const Eigen::Vector3f& rgb) const;
  /// The same for many, three numbers a pixel. @throws spectral::InputError where the lengths do not fit
  void estimate(std::span<const float> rgb, std::span<SkinPixel> pixels, int threads = 1) const;

  /// The way back, in the same view.
  const SkinColours& colours() const;
  /// As SkinColours has them.
  Eigen::Vector3f colour(const SkinPixel& pixel) const { return colours().colour(pixel); }
  void colour(std::span<const SkinPixel> pixels, std::span<float> rgb, int threads = 1) const {
    colours().colour(pixels, rgb, threads);
  }
  SkinSpectrum spectrum(const SkinPixel& pixel) const { return colours().spectrum(pixel); }
  SkinSpectrum albedo(const SkinParameters& skin) const { return colours().albedo(skin); }

  SkinIdentification identification() const;
  SkinChromaticities chromaticities() const;

  /// The most probable skin of a colour, solved without the table, and its gain: for comparison.
  SkinPixel estimateBySolving(const Eigen::Vector3d& rgb) const;

 private:
  struct State;
  std::shared_ptr<const State> m_state;
};

}  // namespace metamer::skin
