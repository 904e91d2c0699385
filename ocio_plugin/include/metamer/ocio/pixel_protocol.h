// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "metamer/sip/spectral_transform.h"
#include "metamer/spectral/pixel_set.h"

namespace metamer::ocio {

/// The part of the error protocol that looks at pixels as cameras make them (docs/error_protocol.md): photographs,
/// clean and noisy, saturated lights, and directions of RGB that no light has, negative ones too. At one exposure.
///
/// A candidate is held against the engine it was made from. How far off it is counts in parts of a pixel's own largest
/// channel, so that a sparkle in the dark cannot hide; on photographs also in codes of a display. A result that is not
/// finite is infinitely far off.
class PixelProtocol {
 public:
  struct Report {
    double p999 = 0;        ///< distance of the largest-deviating channel over the pixel's largest, 99.9th percentile
    double largest = 0;     ///< the same, of the worst pixel
    std::string worstKind;  ///< of that pixel
    Eigen::Vector3d worstRgb = Eigen::Vector3d::Zero();
    double photographCodes = 0;  ///< 99th percentile on photographs, in 8-bit codes of an sRGB display
    double noisyCodes = 0;       ///< the same on noisy ones
    std::size_t count = 0;
  };

  /// @param engine  must outlive the protocol
  PixelProtocol(const sip::SpectralTransform& engine, const std::vector<spectral::SetPixel>& pixels);

  /// @param candidate  turns RGBA pixels of the engine's space into RGBA pixels in place
  Report measure(const std::function<void(std::span<float> rgba)>& candidate) const;

  /// The largest luminance out over in of the engine at the saturated lights, over white's.
  double brightening() const { return m_brightening; }

 private:
  const sip::SpectralTransform& m_engine;
  std::vector<spectral::SetPixel> m_pixels;  // in the engine's space
  std::vector<Eigen::Vector3d> m_expected;
  Eigen::Matrix3d m_displayFromRgb;
  double m_brightening = 1.0;
};

}  // namespace metamer::ocio
