// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <algorithm>

namespace metamer::skin {

/// No skin is outside: beyond, colours are a gain times these.
inline constexpr double kDarkest = 0.02;
inline constexpr double kBrightest = 0.8;

/// Whether a colour can be a skin's times a gain that a float holds. Written so that NaN cannot.
inline bool canBeSkin(const Eigen::Vector3d& rgb) {
  constexpr double kMostLight = 1e37;
  return rgb.allFinite() && rgb.mean() > 0 && rgb.mean() < kMostLight;
}

/// How much brighter or darker a colour is than the nearest that a skin may have. @param mean  of the channels
inline double gainOf(double mean) {
  return mean / std::clamp(mean, kDarkest, kBrightest);
}

}  // namespace metamer::skin
