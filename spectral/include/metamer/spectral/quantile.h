// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace metamer::spectral {

/// The least of the values that a part of them does not exceed: p99 for 0.99 (the nearest-rank definition).
/// @param part  above 0, up to 1
/// @return 0 where there are no values
inline double quantile(std::vector<double> values, double part) {
  if (values.empty()) {
    return 0.0;
  }
  const auto rank = static_cast<std::ptrdiff_t>(std::ceil(part * static_cast<double>(values.size()))) - 1;
  const auto place = values.begin() + rank;
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

}  // namespace metamer::spectral
