// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "metamer/stage/panel_linearity.h"

namespace metamer::stage {

/// Light of one channel by what is sent: a power, light = ((d + offset) / (1 + offset))^gamma, or where none fits, the
/// rising curve through the captures. Drives and light are 1 at full.
struct PanelEotf {
  bool isCurve = false;
  double gamma = 1;                   ///< of the power that is nearest, also where the curve is taken
  double offset = 0;                  ///< of that power, 0 or less: drives up to its opposite give no light
  double gain = 0;                    ///< camera signal at full drive above black, in the channel's strongest component
  double black = 0;                   ///< camera signal at no drive
  double residual = 0;                ///< of what is taken, root mean square, of the captured signal
  std::vector<double> drives, light;  ///< the curve's knots, rising; of a power the captured drives

  /// @param drive  cut to 0 ... 1
  double lightOf(double drive) const;
  /// The least drive that gives so much light; cut to 0 ... 1.
  double driveFor(double light) const;
};

/// A power above this residual gives way to the curve.
inline constexpr double kPowerHolds = 0.025;

/// Fits a channel's ramp; the largest drive counts as full. Noise is taken as a share of the signal.
/// @throws spectral::InputError: as judgeLinearity, fewer than five drives, none of them 0
PanelEotf fitEotf(const DriveSeries& series);
/// The same; what it refuses is refused of a file. @param where  what messages call it
PanelEotf fitEotf(const DriveSeries& series, const std::string& where);

/// Reads a ramp of CSV text with the header "patch,R,G,B", the drive in place of the patch's name.
/// @throws spectral::InputError as parseChart; a drive that is none, a missing value
DriveSeries parseDriveSeries(const std::string& text, const std::string& where);

}  // namespace metamer::stage
