// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "metamer/stage/emitter_match.h"

namespace metamer::stage {

/// One light to reproduce for one observer: all emitters' columns, as the systems of emitter_match.h make them.
struct SelectionCase {
  std::string name;
  MatchSystem system;
};

/// A set of emitters and how well it does.
struct EmitterChoice {
  std::vector<int> emitters;          ///< indices, rising
  double error = 0;                   ///< root mean square of the cases' relative residuals
  std::vector<double> caseResiduals;  ///< relative residual of each case
};

/// Every subset is tried, so there may not be more emitters than this.
inline constexpr int kMostSelectable = 16;

/// The best emitters of each count (section 2.6; LeGendre et al. 2017): all subsets are solved for all cases by
/// non-negative least squares, and the one with the least error wins; of equals the first in the emitters' order.
/// @param cases     at least one, all of the same emitters
/// @param required  emitters that every subset holds, 0 ... emitters - 1
/// @param most      largest count, 1 or more; 0: all
/// @param progress  called now and then with the share done, 0 ... 1; may be empty
/// @return one choice a count, from the required ones' (at least 1) up
/// @throws spectral::InputError: no case, more than kMostSelectable emitters, a case without light or of other emitters
///         than the first, a required emitter that is not there, a count below 0
std::vector<EmitterChoice> selectEmitters(const std::vector<SelectionCase>& cases,
                                          const std::vector<int>& required = {}, int most = 0,
                                          const std::function<void(double)>& progress = {});

}  // namespace metamer::stage
