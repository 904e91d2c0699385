// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "hard_bound/held_bands.h"
#include "hard_bound/reduced_system.h"

namespace metamer::sip {

/// One smoothest spectrum within bounds: the data that every step of its solve shares.
struct BoundedProblem {
  const BandTable& table;
  bool bounded;
  const Eigen::Vector3d& target;
  const Guide* prior;  ///< or null
  int bandCount = table.bandCount();

  /// Distance by which band b breaks a bound (positive), with the bound.
  double violation(const Eigen::VectorXd& spectrum, int b, BandState& bound) const {
    bound = BandState::AtZero;
    if (bounded && spectrum[b] > 1.0) {
      bound = BandState::AtOne;
      return spectrum[b] - 1.0;
    }
    return -spectrum[b];
  }
  /// Whether the spectrum's weights sum to the target.
  bool meets(const Eigen::VectorXd& spectrum) const;
  ReducedSystem system(const BandStates& states) const { return {table, states, prior, ReducedSystem::Held::AtBounds}; }
};

inline double signOf(BandState bound) {
  return bound == BandState::AtOne ? -1.0 : 1.0;
}

/// Distance from a bound that counts as nothing.
double toleranceOf(const Eigen::VectorXd& spectrum);

/// What an answer is wanted for besides itself: F^T dR / dtarget.
struct Linearised {
  const Eigen::MatrixX3d& functionals;  ///< F, B x 3
  Eigen::Matrix3d matrix;
};

/// The answer of a settled system: the spectrum, refined; or the linear piece alone, for which the spectrum is as good
/// as it is. Returns whether it meets the target.
bool conclude(const BoundedProblem& problem, const ReducedSystem& system, Trial& trial, Linearised* linearised);

}  // namespace metamer::sip
