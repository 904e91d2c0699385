// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

namespace metamer::stage {

/// One channel of a panel at rising drives, as the camera saw it.
struct DriveSeries {
  std::vector<double> drives;  ///< what was sent, any unit, at least three different ones
  Eigen::Matrix3Xd rgb;        ///< linear camera RGB, one column a drive
};

struct PanelLinearity {
  double gain = 0;        ///< camera signal a unit of drive, in the channel's strongest camera component
  double black = 0;       ///< signal at no drive
  double exponent = 1;    ///< of signal - black as a power of the drive: 1 for a linear panel, 2.4 for a display curve
  double deviation = 0;   ///< largest distance from the straight line over the largest signal
  double worstDrive = 0;  ///< where
  double hueDrift = 0;    ///< largest change of the light's direction in camera RGB over the series, degrees
};

/// Whether a panel's light is proportional to what is sent, as sections 2.7.1 and 2.7.2 take for given.
/// @throws spectral::InputError: too few drives, colours that are not as many, no rise
PanelLinearity judgeLinearity(const DriveSeries& series);

}  // namespace metamer::stage
