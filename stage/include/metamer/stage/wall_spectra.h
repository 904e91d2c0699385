// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "metamer/spectral/observer.h"
#include "metamer/spectral/spectrum.h"
#include "metamer/stage/rgb_wall.h"

namespace metamer::stage {

/// What there is to be known of an RGB wall, measured: the spectral way to the numbers that a camera captures.
struct WallSpectra {
  std::array<spectral::DomainSamples, 3> emitters;  ///< red, green, blue at a drive of 1, in one unit
  Eigen::Matrix<double, spectral::kDomainSize, 3> camera;
  std::vector<spectral::Spectrum> reflectances;  ///< the chart
  spectral::DomainSamples target;                ///< the light of the real place
  double beta = 1;                               ///< above 0
};

/// The capture that a camera would make of it: the wall at full white, and the perfect reflector in the real place,
/// both exposed to 1 in green; the chart before the calibration square at the wall's exposure.
/// @throws spectral::InputError: a wall or a target that gives the camera no green, no reflectances, a beta that is not
///         above 0
WallCapture captureOf(const WallSpectra& spectra);

}  // namespace metamer::stage
