// SPDX-License-Identifier: Apache-2.0
#include "metamer/sip/smoothest_spectrum.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <vector>

#include "reduced_system.h"

namespace metamer::sip {

namespace {

/// Rounds of force and release before the dual method takes over. Ordinary colours settle in under ten.
constexpr int kMostRounds = 24;
/// A band this far below its bound, relative to the spectrum's largest value, still counts as on it.
constexpr double kBoundTolerance = 1e-12;
/// Constraint residual, relative to the target, that a solution may keep (rounding near the spectral locus).
constexpr double kResidualTolerance = 1e-9;
/// A unit push that moves its own band by less than this does not move it at all: the free bands are all spoken for.
constexpr double kNoSlope = 1e-11;

BandStates statesOf(const ActiveSet& active, int bandCount) {
  BandStates states;
  states.fill(BandState::Free);
  for (int b = 0; b < bandCount; ++b) {
    if (active.atZero[b]) {
      states[b] = BandState::AtZero;
    } else if (active.atOne[b]) {
      states[b] = BandState::AtOne;
    }
  }
  return states;
}

ActiveSet activeSetOf(const BandStates& states, int bandCount) {
  ActiveSet active;
  for (int b = 0; b < bandCount; ++b) {
    if (states[b] == BandState::AtZero) {
      active.atZero.set(static_cast<std::size_t>(b));
    } else if (states[b] == BandState::AtOne) {
      active.atOne.set(static_cast<std::size_t>(b));
    }
  }
  return active;
}

/// One problem: the data that every step of a solve shares.
struct Problem {
  const std::vector<Eigen::Array4d>& weights;
  bool bounded;
  const Eigen::Vector3d& target;
  const Eigen::VectorXd* force;  ///< H P of the prior, or null
  int bandCount;

  /// Distance by which band b breaks a bound (positive), with the bound.
  double violation(const Eigen::VectorXd& spectrum, int b, BandState& bound) const {
    bound = BandState::AtZero;
    if (bounded && spectrum[b] > 1.0) {
      bound = BandState::AtOne;
      return spectrum[b] - 1.0;
    }
    return -spectrum[b];
  }
  bool meets(const Eigen::VectorXd& spectrum) const {
    Eigen::Array4d sum = Eigen::Array4d::Zero();
    for (int b = 0; b < bandCount; ++b) {
      sum += weights[b] * spectrum[b];
    }
    return (sum.matrix().head<3>() - target).norm() <= kResidualTolerance * target.norm();
  }
  ReducedSystem system(const BandStates& states) const {
    return {weights, states, force, ReducedSystem::Held::AtBounds, 0};
  }
};

double signOf(BandState bound) {
  return bound == BandState::AtOne ? -1.0 : 1.0;
}

/// Force and release. Returns whether it settled; `states` then holds the active set, `spectrum` the answer and
/// `response`, where asked for, the linear piece.
bool forceAndRelease(const Problem& problem, BandStates& states, Eigen::VectorXd& spectrum, int& rounds,
                     Eigen::MatrixX3d* response) {
  Eigen::Vector3d multipliers;
  for (int round = 0; round < kMostRounds; ++round) {
    const ReducedSystem system = problem.system(states);
    ++rounds;
    if (!system.fullRank()) {
      return false;
    }
    system.solve(problem.target, false, spectrum, multipliers);
    const double tolerance = kBoundTolerance * spectrum.cwiseAbs().maxCoeff();
    BandStates next = states;
    bool settled = true;
    for (int b = 0; b < problem.bandCount; ++b) {
      if (states[b] == BandState::Free) {
        BandState bound;
        if (problem.violation(spectrum, b, bound) > tolerance) {
          next[b] = bound;
          settled = false;
        }
      } else if (signOf(states[b]) * system.pushAt(b, spectrum, multipliers) < -tolerance) {
        next[b] = BandState::Free;
        settled = false;
      }
    }
    if (settled) {
      system.solve(problem.target, true, spectrum, multipliers);
      if (response != nullptr) {
        *response = system.response();
      }
      return problem.meets(spectrum);
    }
    states = next;
  }
  return false;
}

/// Goldfarb and Idnani's dual method: from the unconstrained optimum, add the most violated bound, giving up held ones
/// whose multiplier would turn negative. The objective rises strictly, so no active set returns.
bool dualActiveSet(const Problem& problem, Eigen::VectorXd& spectrum, BandStates& states, int& rounds,
                   Eigen::MatrixX3d* response) {
  states.fill(BandState::Free);
  Eigen::VectorXd held = Eigen::VectorXd::Zero(problem.bandCount);  // multipliers of the held bands
  Eigen::VectorXd push(problem.bandCount);
  Eigen::VectorXd direction;
  Eigen::VectorXd change(problem.bandCount);
  Eigen::Vector3d multipliers;
  const int mostSteps = 40 * problem.bandCount;
  for (int step = 0; step < mostSteps;) {
    int entering = -1;
    double worst = kBoundTolerance * spectrum.cwiseAbs().maxCoeff();
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
      const ReducedSystem system = problem.system(states);
      system.solve(problem.target, true, spectrum, multipliers);
      if (response != nullptr) {
        *response = system.response();
      }
      ++rounds;
      return problem.meets(spectrum);
    }
    const double sign = signOf(enteringBound);
    push.setZero();
    push[entering] = sign;
    double enteringMultiplier = 0.0;
    for (; step < mostSteps; ++step) {
      const ReducedSystem system(problem.weights, states, &push, ReducedSystem::Held::AtZero, entering);
      ++rounds;
      system.solve(Eigen::Vector3d::Zero(), true, direction, multipliers);
      double releaseStep = std::numeric_limits<double>::infinity();
      int leaving = -1;
      for (int b = 0; b < problem.bandCount; ++b) {
        if (states[b] == BandState::Free) {
          continue;
        }
        change[b] = signOf(states[b]) * system.pushAt(b, direction, multipliers);
        if (change[b] < 0.0 && held[b] / -change[b] < releaseStep) {
          releaseStep = held[b] / -change[b];
          leaving = b;
        }
      }
      BandState bound;
      const double violation = problem.violation(spectrum, entering, bound);
      const double slope = sign * direction[entering];
      const double fullStep = slope > kNoSlope ? violation / slope : std::numeric_limits<double>::infinity();
      const double length = std::min(fullStep, releaseStep);
      if (!std::isfinite(length)) {
        return false;
      }
      if (std::isfinite(fullStep)) {
        spectrum += length * direction;
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

}  // namespace

double roughness(const Eigen::VectorXd& spectrum) {
  return (spectrum.tail(spectrum.size() - 1) - spectrum.head(spectrum.size() - 1)).squaredNorm();
}

SmoothestSpectrumSolver::SmoothestSpectrumSolver(Eigen::Matrix3Xd weights, UpperBound upperBound)
    : m_weights(std::move(weights)), m_upperBound(upperBound) {
  assert(bandCount() >= kMinimumBandCount && bandCount() <= kConvergedBandCount);
  m_lanes.resize(static_cast<std::size_t>(bandCount()));
  for (int b = 0; b < bandCount(); ++b) {
    m_lanes[b] << m_weights.col(b).array(), 0.0;
  }
  BandStates free;
  free.fill(BandState::Free);
  m_unconstrained = ReducedSystem(m_lanes, free, nullptr, ReducedSystem::Held::AtBounds, bandCount() / 2).response();
}

std::optional<SmoothestSpectrumSolver::Solution> SmoothestSpectrumSolver::solve(const Eigen::Vector3d& tristimulus,
                                                                                const Eigen::VectorXd* prior,
                                                                                const ActiveSet* start,
                                                                                Eigen::MatrixX3d* linearPiece) const {
  Solution solution;
  Eigen::VectorXd& spectrum = solution.reflectance;
  Eigen::VectorXd force;
  if (prior != nullptr) {
    force = roughnessGradient(*prior);
    spectrum = *prior + m_unconstrained * (tristimulus - m_weights * *prior);
  } else {
    spectrum = m_unconstrained * tristimulus;
  }
  const Problem problem{m_lanes, m_upperBound == UpperBound::One, tristimulus, prior != nullptr ? &force : nullptr,
                        bandCount()};
  const double tolerance = kBoundTolerance * spectrum.cwiseAbs().maxCoeff();
  BandStates states;
  states.fill(BandState::Free);
  bool within = true;
  for (int b = 0; b < bandCount(); ++b) {
    BandState bound;
    if (problem.violation(spectrum, b, bound) > tolerance) {
      states[b] = bound;
      within = false;
    }
  }
  if (!within) {
    const Eigen::VectorXd relaxed = spectrum;
    const BandStates cold = states;
    bool settled = false;
    if (start != nullptr && !start->empty()) {
      states = statesOf(*start, bandCount());
      settled = forceAndRelease(problem, states, spectrum, solution.rounds, linearPiece);
    }
    if (!settled) {
      states = cold;
      settled = forceAndRelease(problem, states, spectrum, solution.rounds, linearPiece);
    }
    if (!settled) {
      solution.fellBack = true;
      spectrum = relaxed;
      if (!dualActiveSet(problem, spectrum, states, solution.rounds, linearPiece)) {
        return std::nullopt;
      }
    }
    solution.active = activeSetOf(states, bandCount());
  } else if (linearPiece != nullptr) {
    *linearPiece = m_unconstrained;
  }
  // What lies beyond a bound by rounding alone is put on it.
  spectrum = spectrum.cwiseMax(0.0);
  if (problem.bounded) {
    spectrum = spectrum.cwiseMin(1.0);
  }
  return solution;
}

std::optional<SmoothestSpectrumSolver::Solution> SmoothestSpectrumSolver::solveByForcingOnly(
    const Eigen::Vector3d& tristimulus) const {
  Solution solution;
  solution.reflectance = m_unconstrained * tristimulus;
  const Problem problem{m_lanes, false, tristimulus, nullptr, bandCount()};
  BandStates states;
  states.fill(BandState::Free);
  Eigen::Vector3d multipliers;
  const double tolerance = kBoundTolerance * solution.reflectance.cwiseAbs().maxCoeff();
  for (int held = 0; held < bandCount(); ++held) {
    Eigen::Index lowest = 0;
    if (solution.reflectance.minCoeff(&lowest) >= -tolerance) {
      solution.active = activeSetOf(states, bandCount());
      return problem.meets(solution.reflectance) ? std::optional(solution) : std::nullopt;
    }
    states[lowest] = BandState::AtZero;
    const ReducedSystem system = problem.system(states);
    ++solution.rounds;
    if (!system.fullRank()) {
      return std::nullopt;
    }
    system.solve(tristimulus, true, solution.reflectance, multipliers);
  }
  return std::nullopt;
}

}  // namespace metamer::sip
