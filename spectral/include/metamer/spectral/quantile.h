// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "metamer/spectral/argument_checks.h"

namespace metamer::spectral {

/// The smallest value that at least this part of all values does not exceed (the nearest-rank definition): p99 for
/// 0.99.
/// @param values  none NaN
/// @param part    above 0, up to 1
/// @return 0 where there are no values
/// @throws InputError (part)
inline double quantile(std::vector<double> values, double part) {
  requireAbove("part", part, 0.0);
  requireWithin("part", part, 0.0, 1.0);
  if (values.empty()) {
    return 0.0;
  }
  const auto rank = static_cast<std::ptrdiff_t>(std::ceil(part * static_cast<double>(values.size()))) - 1;
  const auto place = values.begin() + rank;
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

}  // namespace metamer::spectral
