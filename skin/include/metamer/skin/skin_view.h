// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "metamer/skin/skin_model.h"
#include "metamer/spectral/chromatic_adaptation.h"
#include "metamer/spectral/observer.h"
#include "metamer/spectral/rgb_space.h"
#include "metamer/spectral/spectrum.h"

namespace metamer::skin {

/// How an albedo picture shows spectra: the light and the observer of its capture, and the linear RGB space that its
/// pixels are in, in which a perfect reflector is (1, 1, 1). Immutable.
class SkinView {
 public:
  using Weights = Eigen::Matrix<double, 3, kSkinBands>;
  using Basis = Eigen::Matrix<double, kSkinBands, 3>;

  /// The response is adapted to the space's white in full.
  /// @param observer  with a matrix to XYZ of its own
  /// @throws spectral::InputError where it has none, where it has no inverse, or where the light gives it no response
  SkinView(const spectral::Spectrum& illuminant, const spectral::Observer& observer, const spectral::RgbSpace& space,
           spectral::ChromaticAdaptation adaptation = spectral::ChromaticAdaptation::VonKries);

  /// Linear RGB of a reflectance at the skin bands, piecewise linear between them: rows are integrals over the light
  /// and the observer, exact over 1 nm.
  const Weights& rgbWeights() const { return m_rgbWeights; }
  /// The smoothest reflectances of given RGB: rgbWeights() times it is the identity, and (1, 1, 1) gives 1 everywhere
  /// (section 5.5 without bounds). Where the observer tells fewer than three colours apart, the nearest it can do.
  const Basis& smoothest() const { return m_smoothest; }
  /// How many colours the observer tells apart under this light: 3 for all that see colour.
  int rank() const { return m_rank; }

 private:
  Weights m_rgbWeights;
  Basis m_smoothest;
  int m_rank = 3;
};

}  // namespace metamer::skin
