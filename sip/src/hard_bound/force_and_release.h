// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hard_bound/bounded_problem.h"

namespace metamer::sip {

/// Forces the bands that break a bound, where none is held. Returns whether none did.
bool force(const BoundedProblem& problem, const Eigen::VectorXd& spectrum, BandStates& states);

/// Forces every free band that breaks a bound and releases every held one that its bound pulls, together, until nothing
/// changes. Returns whether that came to be and the answer meets the target; `states` then holds the active set and
/// `trial` the answer.
/// @param rounds  grows by the systems solved
/// @param linearised  see conclude(); or null
bool forceAndRelease(const BoundedProblem& problem, BandStates& states, Trial& trial, int& rounds,
                     Linearised* linearised);

}  // namespace metamer::sip
