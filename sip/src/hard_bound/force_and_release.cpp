// SPDX-License-Identifier: Apache-2.0
#include "hard_bound/force_and_release.h"

#include <algorithm>
#include <limits>

namespace metamer::sip {

namespace {

/// Rounds of force and release before the dual method takes over. Ordinary colours settle in under ten.
constexpr int kMostRounds = 24;

/// Forces the free bands of a stretch that break a bound. Returns whether none did.
bool force(const BoundedProblem& problem, const Eigen::VectorXd& spectrum, int first, int end, double tolerance,
           BandStates& states) {
  const double highest = problem.bounded ? 1.0 + tolerance : std::numeric_limits<double>::infinity();
  const auto stretch = spectrum.segment(first, end - first);
  if (stretch.minCoeff() >= -tolerance && stretch.maxCoeff() <= highest) {
    return true;
  }
  for (int b = first; b < end; ++b) {
    if (spectrum[b] < -tolerance) {
      states[static_cast<std::size_t>(b)] = BandState::AtZero;
    } else if (spectrum[b] > highest) {
      states[static_cast<std::size_t>(b)] = BandState::AtOne;
    }
  }
  return false;
}

/// Forces free bands that break a bound and releases held ones whose bound pulls them. Returns whether none did; else
/// `revised` holds what comes next.
bool revise(const BoundedProblem& problem, const ReducedSystem& system, const Trial& trial, const BandStates& states,
            BandStates& revised) {
  const double tolerance = toleranceOf(trial.spectrum);
  std::copy_n(states.begin(), problem.bandCount, revised.begin());
  bool settled = true;
  const auto release = [&](int band) {
    revised[static_cast<std::size_t>(band)] = BandState::Free;
    settled = false;
  };
  for (int first = 0, end = 0; first < problem.bandCount; first = end) {
    end = endOfStretch(states, first, problem.bandCount);
    const BandState state = states[static_cast<std::size_t>(first)];
    if (state == BandState::Free) {
      settled = force(problem, trial.spectrum, first, end, tolerance, revised) && settled;
      continue;
    }
    const double sign = signOf(state);
    for (const int edge : {first, end - 1}) {
      if (sign * system.pushAt(edge, trial) < -tolerance) {
        release(edge);
      }
    }
    // Inside a stretch the spectrum is level, and only the weights and the guide push. Mostly none is released.
    if (problem.prior == nullptr && end - first > 2) {
      const auto inside = trial.pull.segment(first + 1, end - first - 2);
      if (state == BandState::AtZero ? inside.maxCoeff() <= tolerance : inside.minCoeff() >= -tolerance) {
        continue;
      }
    }
    for (int b = first + 1; b + 1 < end; ++b) {
      if (sign * (trial.pull[b] + system.guideForce(b)) > tolerance) {
        release(b);
      }
    }
  }
  return settled;
}

}  // namespace

bool force(const BoundedProblem& problem, const Eigen::VectorXd& spectrum, BandStates& states) {
  return force(problem, spectrum, 0, problem.bandCount, toleranceOf(spectrum), states);
}

bool forceAndRelease(const BoundedProblem& problem, BandStates& states, Trial& trial, int& rounds,
                     Linearised* linearised) {
  BandStates revised{};
  for (int round = 0; round < kMostRounds; ++round) {
    const ReducedSystem system = problem.system(states);
    ++rounds;
    if (!system.fullRank()) {
      return false;
    }
    system.solve(problem.target, trial);
    if (revise(problem, system, trial, states, revised)) {
      return conclude(problem, system, trial, linearised);
    }
    std::copy_n(revised.begin(), problem.bandCount, states.begin());
  }
  return false;
}

}  // namespace metamer::sip
