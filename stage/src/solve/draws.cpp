// SPDX-License-Identifier: Apache-2.0
#include "solve/draws.h"

#include <cmath>
#include <limits>

#include "metamer/spectral/argument_checks.h"

namespace metamer::stage {
namespace {

constexpr int kFewestSamples = 20;
constexpr int kMostSamples = 100'000;

}  // namespace

void requireDraws(const IntervalOptions& options) {
  spectral::requireWithin("noise", options.noise.relative, 0, 1);
  spectral::requireWithin("noise floor", options.noise.floor, 0, std::numeric_limits<double>::max());
  spectral::requireWithin("samples", options.samples, kFewestSamples, kMostSamples);
}

void runDraws(const IntervalOptions& options, const std::function<void(int)>& body) {
  if (options.runAll) {
    options.runAll(options.samples, body);
    return;
  }
  for (int i = 0; i < options.samples; ++i) {
    body(i);
  }
}

double Noise::next(double value) {
  return std::hypot(m_options.noise.relative * value, m_options.noise.floor) *
         normalNumber(m_options.seed, m_sample, m_place++);
}

}  // namespace metamer::stage
