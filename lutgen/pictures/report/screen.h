// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <span>
#include <string>

#include "apply/picture_space.h"
#include "metamer/spectral/rgb_space.h"

namespace metamer::lutgen {

/// Linear colours as an sRGB screen shows them: white as white, what it cannot show clipped.
class Screen {
 public:
  /// @param space  of the colours
  /// @param rec709  the screen's primaries and white
  Screen(const spectral::RgbSpace& space, const spectral::RgbSpace& rec709) : m_toRec709(between(space, rec709)) {}

  /// Red, green, blue, 0 ... 1, with the screen's curve. What is no number is 0.
  Eigen::Vector3f codes(const Eigen::Vector3f& rgb) const;
  /// RGBA in place; alpha is left alone.
  void show(std::span<float> rgba) const;
  /// "#1f5fa8"
  std::string hex(const Eigen::Vector3d& rgb) const;

 private:
  PixelFunction m_toRec709;
};

}  // namespace metamer::lutgen
