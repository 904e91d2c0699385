// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace metamer::spectral_ref {

/// Probability that counts drawn from the expected ones differ from them as much as these do (Pearson's chi-square;
/// cells that expect fewer than five are pooled).
double chiSquareProbability(const std::vector<double>& counts, const std::vector<double>& expected);

/// Probability of a |z| this large in one of `tests` independent standard normal numbers (Sidak).
double sidakProbability(double z, int tests);

}  // namespace metamer::spectral_ref
