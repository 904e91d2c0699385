// SPDX-License-Identifier: Apache-2.0
#include "transport/layer_checks.h"

#include <limits>

#include "metamer/spectral/argument_checks.h"

namespace metamer::skin {

void requireLayers(const LayerOptics& layers) {
  constexpr double kMost = std::numeric_limits<double>::max();
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  spectral::requireWithin("epidermis absorption", layers.epidermisAbsorption, 0, kMost);
  spectral::requireWithin("dermis absorption", layers.dermisAbsorption, 0, kMost);
  spectral::requireAbove("scattering", layers.scattering, 0);
  spectral::requireWithin("anisotropy", layers.anisotropy, 0, 0.99);
  spectral::requireWithin("epidermis thickness", layers.epidermisThicknessCm, 0, kMost);
  spectral::requireWithin("dermis thickness", layers.dermisThicknessCm, 0, kInfinite);
}

}  // namespace metamer::skin
