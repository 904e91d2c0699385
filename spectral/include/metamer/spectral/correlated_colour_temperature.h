// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace metamer::spectral {

struct CorrelatedColourTemperature {
  double cctK = 0;  ///< temperature of the nearest blackbody in CIE 1960 u, v
  double duv = 0;   ///< signed distance to it, positive above the Planckian locus (greenish)
};

/// Nearest blackbody (CIE 1931 2 degree) by minimisation over 1000 ... 100000 K; ANSI C78.377 sign of Duv.
CorrelatedColourTemperature correlatedColourTemperature(const Eigen::Vector3d& xyz,
                                                        const Eigen::Matrix<double, 401, 3>& observer1931);

}  // namespace metamer::spectral
