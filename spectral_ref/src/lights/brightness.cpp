// SPDX-License-Identifier: Apache-2.0
#include "lights/brightness.h"

#include <algorithm>
#include <cmath>

namespace metamer::spectral_ref {

double brightnessOf(const std::vector<LightBounds>& lights, const CameraSettings& camera) {
  const Vec3 origin = camera.origin.cast<float>();
  const Vec3 target = camera.target.cast<float>();
  double irradiance = 0;
  for (const LightBounds& light : lights) {
    double given = static_cast<double>(light.intensity);
    if (!light.isInfinite) {
      const Vec3 center = 0.5F * (light.least + light.most);
      const float distance = std::max((center - origin).squaredNorm(), (center - target).squaredNorm());
      // A light that is as near as it is large gives no more than its own radiance.
      const float squared = std::max(distance, 0.25F * (light.most - light.least).squaredNorm());
      given /= static_cast<double>(squared);
    }
    irradiance += std::isfinite(given) ? given : 0.0;
  }
  const double brightness = irradiance * static_cast<double>(kInversePi);
  return brightness > 0 && std::isfinite(brightness) ? brightness : 1.0;
}

}  // namespace metamer::spectral_ref
