// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "metamer/skin/skin_parameters.h"

namespace metamer::skin {

/// A pixel of an albedo picture as skin. Its colour is gain times the skin's, plus the residual.
struct SkinPixel {
  std::array<float, 5> skin{};      ///< melanin, blood, thickness in micrometres, eumelanin, deoxyhaemoglobin
  float gain = 1;                   ///< how much brighter or darker than any skin of its chromaticity; 1 inside
  std::array<float, 3> residual{};  ///< linear RGB

  SkinParameters parameters() const { return {skin[0], skin[1], skin[2], skin[3], skin[4]}; }
};

}  // namespace metamer::skin
