// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hard_bound/bounded_problem.h"

namespace metamer::sip {

/// Goldfarb and Idnani's dual method: from the unconstrained optimum, add the most violated bound, giving up held ones
/// whose multiplier would turn negative. The objective rises strictly, so no active set returns.
/// @param trial  holds the unconstrained optimum, and then the answer
/// @param rounds  grows by the systems solved
/// @return false where no spectrum within the bounds has the target
bool dualActiveSet(const BoundedProblem& problem, BandStates& states, Trial& trial, int& rounds,
                   Linearised* linearised);

}  // namespace metamer::sip
