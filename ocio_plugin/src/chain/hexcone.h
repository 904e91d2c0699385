// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace metamer::ocio {

/// A colour by hue, saturation and value, as OCIO's fixed function RGB_TO_HSV has them: Smith's hexcone (1978), carried
/// on to colours with channels below zero. Every colour of R^3 has such coordinates, and all but value are the same at
/// every exposure.
///
/// Hue is 0 ... 1, round the neutral axis. Saturation is 0 at neutral, 1 where the least channel is zero, and 2 where
/// it is as far below zero as the largest is above. There value, which is the largest channel plus what is below zero,
/// changes its sign; beyond, for colours more below zero than above, value is negative and saturation falls back to 0
/// at neutral.
struct Hexcone {
  double hue = 0;
  double saturation = 0;
  double value = 0;
};

Hexcone hexconeOf(const Eigen::Vector3d& rgb);

/// The colour with given coordinates, of a saturation below 2 (at 2 a value stands for no colour).
Eigen::Vector3d colourOf(const Hexcone& hexcone);

}  // namespace metamer::ocio
