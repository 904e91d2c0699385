// SPDX-License-Identifier: Apache-2.0
#include "statistical/chi_square.h"

#include <cmath>
#include <cstddef>

namespace metamer::spectral_ref {

double chiSquareProbability(const std::vector<double>& counts, const std::vector<double>& expected) {
  constexpr double kFewest = 5.0;
  double statistic = 0;
  double pooledCount = 0;
  double pooledExpected = 0;
  int cells = 0;
  const auto add = [&](double count, double expectation) {
    statistic += (count - expectation) * (count - expectation) / expectation;
    ++cells;
  };
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (expected[i] >= kFewest) {
      add(counts[i], expected[i]);
    } else {
      pooledCount += counts[i];
      pooledExpected += expected[i];
    }
  }
  if (pooledExpected > 0) {
    add(pooledCount, pooledExpected);
  } else if (pooledCount > 0) {
    return 0;  // where nothing can be
  }
  // Wilson and Hilferty: the cube root of chi-square over its degrees of freedom is all but normal.
  const double degrees = cells - 1;
  const double spread = 2.0 / (9.0 * degrees);
  const double z = (std::cbrt(statistic / degrees) - (1.0 - spread)) / std::sqrt(spread);
  return 0.5 * std::erfc(z / std::sqrt(2.0));
}

double sidakProbability(double z, int tests) {
  const double one = std::erfc(std::abs(z) / std::sqrt(2.0));
  return -std::expm1(tests * std::log1p(-one));
}

}  // namespace metamer::spectral_ref
