// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>

#include "metamer/skin/skin_colours.h"
#include "metamer/spectral/data_library.h"
#include "metamer/spectral/rgb_space.h"

namespace metamer::skin {

/// Colours to skins by the chapter's encoder-decoder (section 3.6), for comparison with SkinEstimator: small networks
/// that script/train_skin.py trained on skins of the prior, in daylight (D65) seen by CIE 1931 2. Immutable, safe
/// between threads.
class SkinNetwork {
 public:
  /// What it was trained by.
  enum class Loss {
    Rgb,       ///< equation 3.5: parameters, and colours by the decoder's
    Spectral,  ///< equation 3.6: parameters, the spectral angle, and colours of the decoder's spectra
  };

  /// @param space  linear, of the pixels
  /// @throws spectral::InputError where the weights are missing or malformed, and as SkinColours
  SkinNetwork(const spectral::DataLibrary& library, const spectral::RgbSpace& space, Loss loss);

  /// The skin of one pixel's linear RGB, as SkinEstimator has it: beyond the brightness of skin with a gain, what the
  /// model's albedo (not the decoder's) lacks of the colour as a residual.
  SkinPixel estimate(const Eigen::Vector3f& rgb) const;
  /// The same for many, three numbers a pixel, on 1 ... 256 threads.
  /// @throws spectral::InputError outside that range, and where the lengths do not fit
  void estimate(std::span<const float> rgb, std::span<SkinPixel> pixels, int threads = 1) const;
  /// The way back.
  const SkinColours& colours() const;

  /// The decoder: of Loss::Spectral the reflectance at the skin bands, of Loss::Rgb linear Rec.709 (three numbers).
  Eigen::VectorXd decoded(const SkinParameters& skin) const;

 private:
  struct State;
  std::shared_ptr<const State> m_state;
};

}  // namespace metamer::skin
