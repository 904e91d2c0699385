// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <random>
#include <vector>

#include "soft_bound/soft_bound_solver.h"

namespace metamer::sip {

/// Tristimuli of every kind, the same ones every run: of reflectances, on and close to the locus, mirrored and beyond
/// all lights, with a channel at next to nothing, and where a band is just about to be clamped.
std::vector<Eigen::Vector3d> everyTristimulus(const SoftBoundSolver& solver, int count, unsigned seed = 1);

/// A prior without response: a smooth random spectrum less the smooth spectrum of its own response, times `size`.
BandVector randomPrior(const SoftBoundSolver& solver, std::mt19937& random, double size);

/// How far a spectrum is from meeting the optimality conditions of its problem, worked out with dense algebra.
struct Optimality {
  double missed = 0;    ///< of the response, over its size
  double gradient = 0;  ///< what the multipliers leave of the gradient, over the size of its parts
};
Optimality optimalityOf(const SoftBoundSolver& solver, double relaxation, const BandVector& spectrum,
                        const Eigen::Vector3d& tristimulus, const BandVector* prior);

}  // namespace metamer::sip
