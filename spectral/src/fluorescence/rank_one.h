// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace metamer::spectral {

/// Factors of a re-radiation above the diagonal's wavelengths, a row an emission, a column an excitation.
struct ShiftedFactors {
  Eigen::MatrixXd factors;  ///< 0 elsewhere
  Eigen::MatrixXd is;       ///< 1 where emission lies above excitation, else 0
};

/// factors(o, i) = emission(o) excitation(i) where emission lies above excitation. Neither is negative.
struct RankOne {
  Eigen::VectorXd emission;
  Eigen::VectorXd excitation;
};

/// No more photons come back than the surface takes.
struct PhotonBounds {
  double stepNm = 0;           ///< of emissions and excitations
  Eigen::VectorXd photons;     ///< of an energy, by emission: in proportion to its wavelength
  Eigen::VectorXd excitation;  ///< largest, by excitation
};

/// By alternating least squares.
RankOne nearestRankOne(const ShiftedFactors& shifted);

/// The same where errors count as they are seen: of an error R(o, i) the squares of Cᵀ R e, C the curves and e smooth
/// lights, and `unseen` of those of R e.
/// @param from    where to begin
/// @param bounds  of excitations, the emission's photons being one
/// @param curves  of an observer, a row an emission
RankOne nearestAsSeen(const ShiftedFactors& shifted, const RankOne& from, const PhotonBounds& bounds,
                      const Eigen::MatrixX3d& curves, double unseen);

}  // namespace metamer::spectral
