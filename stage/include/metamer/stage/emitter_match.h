// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "metamer/spectral/observer.h"
#include "metamer/spectral/spectrum.h"
#include "metamer/stage/non_negative_least_squares.h"

namespace metamer::stage {

/// How the drives of several emitters are chosen (section 2.4; Wenger et al. 2003).
enum class MatchMethod {
  Spectral,              ///< SIM: the light's spectrum
  MetamericIlluminant,   ///< MIM: the light's colour to an observer
  MetamericReflectance,  ///< MRM: the colours of materials in it, to an observer
};

/// "sim", "mim", "mrm". @throws spectral::InputError for any other
MatchMethod matchMethodFromName(const std::string& name);

/// How differences of MRM count in a linear system; solvePerceptualMatch counts them as they are seen.
enum class MatchWeights {
  Absolute,  ///< squared tristimulus differences
  Relative,  ///< divided by the target's value (Wenger et al. 2003)
};

/// Emitters and a target as columns and a vector that drives should make: |matrix * drives - target| is minimised.
struct MatchSystem {
  Eigen::MatrixXd matrix;  ///< one column an emitter, at a drive of 1
  Eigen::VectorXd target;
};

/// Emitters at a drive of 1: one column each, on the 1 nm domain.
using EmitterColumns = Eigen::Matrix<double, spectral::kDomainSize, Eigen::Dynamic>;
using ObserverCurves = Eigen::Matrix<double, spectral::kDomainSize, 3>;

/// SIM: a row a nanometre.
MatchSystem spectralSystem(const EmitterColumns& emitters, const spectral::DomainSamples& target);

/// MIM: three rows, the response to the light, divided by the target's own level (its second component).
/// @throws spectral::InputError where the target gives the observer no light
MatchSystem illuminantSystem(const EmitterColumns& emitters, const spectral::DomainSamples& target,
                             const ObserverCurves& curves);

/// MRM: three rows a reflectance (responses one after another), divided by the target's own level on the perfect
/// reflector.
/// @throws spectral::InputError as illuminantSystem, and where there are no reflectances
MatchSystem reflectanceSystem(const EmitterColumns& emitters, const spectral::DomainSamples& target,
                              const ObserverCurves& curves, const std::vector<spectral::DomainSamples>& reflectances,
                              MatchWeights weights = MatchWeights::Absolute);

/// MRM without any spectrum (section 2.5.2): a chart's picture under each emitter, and under the target.
/// @param charts  one an emitter, 3 x patches
/// @throws spectral::InputError where one has other patches than the target, or there are none
MatchSystem chartSystem(const std::vector<Eigen::Matrix3Xd>& charts, const Eigen::Matrix3Xd& target,
                        MatchWeights weights = MatchWeights::Absolute);

/// Rows of two systems of the same emitters, the second's weighted.
/// @param weight  of the second's squares, not negative
MatchSystem together(const MatchSystem& first, const MatchSystem& second, double weight);

/// The same in as many rows as there are emitters, and one: |matrix * drives - target| is the same for all drives. For
/// many materials.
MatchSystem condensed(const MatchSystem& system);

struct EmitterMatch {
  Eigen::VectorXd drives;         ///< in the emitters' own units, never below 0
  double residualNorm = 0;        ///< |matrix * drives - target|
  double relativeResidual = 0;    ///< that over |target|; 0 for an exact match
  int rank = 0;                   ///< of the emitters for this method; below their number the drives are the shortest
  double condition = 0;           ///< of the matrix with columns of unit length; infinite where emitters depend
  std::vector<int> deadEmitters;  ///< that add nothing to what is matched
};

/// Non-negative least squares, within limits where given; of equally good drives the shortest (minimum norm).
/// @throws spectral::InputError: no emitter, more than 64, a target of nothing or of another length than the matrix,
///         no emitter with any light
EmitterMatch solveMatch(const MatchSystem& system, const DriveLimits& limits = {});

/// What an observer's responses look like.
struct SeenResponses {
  Eigen::Matrix3d xyzFromResponse;    ///< any scale
  Eigen::Vector3d white;              ///< the response to what counts as white (L* = 100), in the system's scale
  Eigen::VectorXd patchWeights = {};  ///< in the mean, one a patch, above 0; empty: 1
};

/// MRM by what is seen: the least mean CIEDE2000 over the patches, where squared tristimulus differences let a shift of
/// all greys buy a bright patch. Gauss-Newton steps by non-negative least squares, reweighted to the mean (iteratively
/// reweighted least squares), from the least-squares match and from each of `starts`; the best end is taken, so the
/// mean is never above that of any start. The objective is not convex: a local minimum.
///
/// `residualNorm`, `relativeResidual`, `rank` and `condition` are of the system, as of solveMatch.
/// @param system   three rows a patch, with absolute weights
/// @param starts   other drives to set out from, such as MIM's; those beyond the limits are left out
/// @throws spectral::InputError as solveMatch, and where white has no luminance, rows are not three a patch, weights
///         are not one a patch, or a start has not a drive for each emitter
EmitterMatch solvePerceptualMatch(const MatchSystem& system, const SeenResponses& seen,
                                  const std::vector<Eigen::VectorXd>& starts, const DriveLimits& limits = {});

}  // namespace metamer::stage
