// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>

#include "metamer/skin/skin_pixel.h"
#include "metamer/skin/skin_prior.h"
#include "metamer/skin/skin_table.h"
#include "metamer/skin/skin_view.h"

namespace metamer::skin {

/// Skins to colours and spectra: the forward model by its table, its mean misfit to people repaired, as a view shows
/// it. All that maps that are there already need: a tenth of a second to make. Immutable, safe between threads.
class SkinColours {
 public:
  /// @throws spectral::InputError as SkinModel and SkinPrior
  SkinColours(const spectral::DataLibrary& library, const SkinView& view);

  const SkinPrior& prior() const;
  const SkinView& view() const;

  /// The albedo at the skin bands. @throws spectral::InputError where requireSkin does
  SkinSpectrum albedo(const SkinParameters& skin) const;
  /// Linear RGB of that albedo; nowhere cut at 0, for slopes' sake. @throws spectral::InputError likewise
  Eigen::Vector3d rgb(const SkinParameters& skin) const;

  /// The colour of a pixel: of an estimated one that was not edited, what it was, to 1e-6 of its size. Parameters
  /// outside their ranges are cut to them.
  Eigen::Vector3f colour(const SkinPixel& pixel) const;
  /// The same for many, three numbers a pixel, on 1 ... 256 threads.
  /// @throws spectral::InputError outside that range, and where the lengths do not fit
  void colour(std::span<const SkinPixel> pixels, std::span<float> rgb, int threads = 1) const;
  /// Its reflectance at the skin bands: gain times the skin's, and the residual as the smoothest spectrum of its
  /// colour, so that it has exactly that colour in this view. May be negative where the residual is.
  SkinSpectrum spectrum(const SkinPixel& pixel) const;

  /// The pixel that is a skin times a gain, and whose residual is what these leave of a colour: colour() gives it back.
  /// A gain of 0 is a pixel that is no skin at all, its own residual.
  SkinPixel pixel(const SkinParameters& skin, double gain, const Eigen::Vector3f& rgb) const;

 private:
  struct State;
  std::shared_ptr<const State> m_state;
};

}  // namespace metamer::skin
