// SPDX-License-Identifier: Apache-2.0
#include "hard_bound/dual_active_set.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace metamer::sip {

namespace {

/// A unit push that moves its own band by less than this does not move it at all: the free bands are all spoken for.
constexpr double kNoSlope = 1e-11;

}  // namespace

bool dualActiveSet(const BoundedProblem& problem, BandStates& states, Trial& trial, int& rounds,
                   Linearised* linearised) {
  states.fill(BandState::Free);
  Eigen::VectorXd held = Eigen::VectorXd::Zero(problem.bandCount);  // multipliers of the held bands
  Guide push{Eigen::VectorXd::Zero(problem.bandCount)};
  Eigen::VectorXd& spectrum = trial.spectrum;
  Trial direction;
  Eigen::VectorXd change(problem.bandCount);
  const int mostSteps = 40 * problem.bandCount;
  for (int step = 0; step < mostSteps;) {
    int entering = -1;
    double worst = toleranceOf(spectrum);
    BandState enteringBound = BandState::AtZero;
    for (int b = 0; b < problem.bandCount; ++b) {
      BandState bound;
      if (states[b] == BandState::Free && problem.violation(spectrum, b, bound) > worst) {
        worst = problem.violation(spectrum, b, bound);
        entering = b;
        enteringBound = bound;
      }
    }
    if (entering < 0) {
      ++rounds;
      const ReducedSystem system = problem.system(states);
      system.solve(problem.target, trial);
      return conclude(problem, system, trial, linearised);
    }
    const double sign = signOf(enteringBound);
    // What a push at one band alone makes: level up to there, then straight.
    for (int b = 0; b < problem.bandCount; ++b) {
      push.values[b] = -sign * std::max(0, b - entering);
    }
    push.endSlope = -sign;
    double enteringMultiplier = 0.0;
    for (; step < mostSteps; ++step) {
      const ReducedSystem system(problem.table, states, &push, ReducedSystem::Held::AtZero);
      ++rounds;
      system.solve(Eigen::Vector3d::Zero(), direction);
      system.refine(Eigen::Vector3d::Zero(), direction);
      double releaseStep = std::numeric_limits<double>::infinity();
      int leaving = -1;
      for (int b = 0; b < problem.bandCount; ++b) {
        if (states[b] == BandState::Free) {
          continue;
        }
        change[b] = signOf(states[b]) * system.pushAt(b, direction);
        if (change[b] < 0.0 && held[b] / -change[b] < releaseStep) {
          releaseStep = held[b] / -change[b];
          leaving = b;
        }
      }
      BandState bound;
      const double violation = problem.violation(spectrum, entering, bound);
      const double slope = sign * direction.spectrum[entering];
      const double fullStep = slope > kNoSlope ? violation / slope : std::numeric_limits<double>::infinity();
      const double length = std::min(fullStep, releaseStep);
      if (!std::isfinite(length)) {
        return false;
      }
      if (std::isfinite(fullStep)) {
        spectrum += length * direction.spectrum;
      }
      for (int b = 0; b < problem.bandCount; ++b) {
        if (states[b] != BandState::Free) {
          held[b] += length * change[b];
        }
      }
      enteringMultiplier += length;
      if (fullStep <= releaseStep) {
        states[entering] = enteringBound;
        held[entering] = enteringMultiplier;
        ++step;
        break;
      }
      states[leaving] = BandState::Free;
      held[leaving] = 0.0;
    }
  }
  return false;
}

}  // namespace metamer::sip
