// SPDX-License-Identifier: Apache-2.0
#include "report/screen.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "metamer/spectral/formatted.h"
#include "metamer/spectral/srgb_curve.h"

namespace metamer::lutgen {

Eigen::Vector3f Screen::codes(const Eigen::Vector3f& rgb) const {
  std::array<float, 4> pixel = {rgb[0], rgb[1], rgb[2], 1.0F};
  if (m_toRec709) {
    m_toRec709(pixel);
  }
  Eigen::Vector3f shown;
  for (Eigen::Index k = 0; k < 3; ++k) {
    const float value = pixel[static_cast<std::size_t>(k)];
    const float clipped = std::isnan(value) ? 0.0F : std::clamp(value, 0.0F, 1.0F);
    shown[k] = static_cast<float>(spectral::srgbFromLinear(clipped));
  }
  return shown;
}

void Screen::show(std::span<float> rgba) const {
  for (std::size_t at = 0; at + 4 <= rgba.size(); at += 4) {
    Eigen::Map<Eigen::Vector3f> pixel(&rgba[at]);
    pixel = codes(pixel);
  }
}

std::string Screen::hex(const Eigen::Vector3d& rgb) const {
  const Eigen::Vector3f shown = codes(rgb.cast<float>());
  const auto code = [&](Eigen::Index k) { return static_cast<int>(std::lround(255.0F * shown[k])); };
  return spectral::formatted("#%02x%02x%02x", code(0), code(1), code(2));
}

}  // namespace metamer::lutgen
