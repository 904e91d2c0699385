// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>

namespace metamer::ocio {

/// CIE xy of AP1's primaries (Academy S-2014-004), ACEScg's: their triangle holds nearly all that is seen.
inline std::array<Eigen::Vector2d, 3> ap1Primaries() {
  return {{{0.713, 0.293}, {0.165, 0.830}, {0.128, 0.044}}};
}

}  // namespace metamer::ocio
