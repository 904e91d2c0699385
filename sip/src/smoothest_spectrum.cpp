// SPDX-License-Identifier: Apache-2.0
#include "metamer/sip/smoothest_spectrum.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "band_table.h"
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

BandStates statesOf(const ActiveSet& active) {
  BandStates states;
  states.fill(BandState::Free);
  for (const HeldStretch& stretch : active.stretches) {
    std::fill(states.begin() + stretch.first, states.begin() + stretch.end,
              stretch.atOne ? BandState::AtOne : BandState::AtZero);
  }
  return states;
}

/// Behind the bands from `first` on that share its state.
int endOfStretch(const BandStates& states, int first, int bandCount) {
  int end = first + 1;
  while (end < bandCount && states[static_cast<std::size_t>(end)] == states[static_cast<std::size_t>(first)]) {
    ++end;
  }
  return end;
}

ActiveSet activeSetOf(const BandStates& states, int bandCount) {
  ActiveSet active;
  for (int first = 0, end = 0; first < bandCount; first = end) {
    end = endOfStretch(states, first, bandCount);
    const BandState state = states[static_cast<std::size_t>(first)];
    if (state != BandState::Free) {
      active.stretches.push_back(
          {static_cast<std::int16_t>(first), static_cast<std::int16_t>(end), state == BandState::AtOne});
    }
  }
  return active;
}

/// One problem: the data that every step of a solve shares.
struct Problem {
  const BandTable& table;
  bool bounded;
  const Eigen::Vector3d& target;
  const Guide* prior;  ///< or null
  int bandCount = table.bandCount();

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
      sum += table.weight(b) * spectrum[b];
    }
    return (sum.matrix().head<3>() - target).norm() <= kResidualTolerance * target.norm();
  }
  ReducedSystem system(const BandStates& states) const { return {table, states, prior, ReducedSystem::Held::AtBounds}; }
};

double signOf(BandState bound) {
  return bound == BandState::AtOne ? -1.0 : 1.0;
}

/// Distance that counts as nothing.
double toleranceOf(const Eigen::VectorXd& spectrum) {
  return kBoundTolerance * spectrum.cwiseAbs().maxCoeff();
}

/// Forces the free bands of a stretch that break a bound. Returns whether none did.
bool force(const Problem& problem, const Eigen::VectorXd& spectrum, int first, int end, double tolerance,
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

/// The same for all bands, where none is held.
bool force(const Problem& problem, const Eigen::VectorXd& spectrum, BandStates& states) {
  return force(problem, spectrum, 0, problem.bandCount, toleranceOf(spectrum), states);
}

/// Forces free bands that break a bound and releases held ones whose bound pulls them. Returns whether none did.
bool revise(const Problem& problem, const ReducedSystem& system, const Eigen::VectorXd& spectrum,
            const Eigen::Vector3d& multipliers, BandStates& states) {
  const double tolerance = toleranceOf(spectrum);
  const BandStates former = states;
  bool settled = true;
  for (int first = 0, end = 0; first < problem.bandCount; first = end) {
    end = endOfStretch(former, first, problem.bandCount);
    const BandState state = former[static_cast<std::size_t>(first)];
    if (state == BandState::Free) {
      settled = force(problem, spectrum, first, end, tolerance, states) && settled;
      continue;
    }
    const double sign = signOf(state);
    for (int b = first; b < end; ++b) {
      // Inside a stretch the spectrum is level, and only the weights and the guide push.
      const bool inside = b > first && b + 1 < end;
      const double push = inside ? -system.pullAt(b, multipliers) : system.pushAt(b, spectrum, multipliers);
      if (sign * push < -tolerance) {
        states[static_cast<std::size_t>(b)] = BandState::Free;
        settled = false;
      }
    }
  }
  return settled;
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
    BandStates next = states;
    if (revise(problem, system, spectrum, multipliers, next)) {
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
  Guide push{Eigen::VectorXd::Zero(problem.bandCount)};
  Eigen::VectorXd direction;
  Eigen::VectorXd change(problem.bandCount);
  Eigen::Vector3d multipliers;
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
      const ReducedSystem system = problem.system(states);
      system.solve(problem.target, true, spectrum, multipliers);
      if (response != nullptr) {
        *response = system.response();
      }
      ++rounds;
      return problem.meets(spectrum);
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

bool ActiveSet::holds(int band) const {
  return std::any_of(stretches.begin(), stretches.end(),
                     [band](const HeldStretch& stretch) { return stretch.first <= band && band < stretch.end; });
}

ActiveSet between(const ActiveSet& a, const ActiveSet& b) {
  ActiveSet middle = a;
  if (a.stretches.size() != b.stretches.size()) {
    return middle;
  }
  for (std::size_t i = 0; i < a.stretches.size(); ++i) {
    HeldStretch& stretch = middle.stretches[i];
    const HeldStretch& other = b.stretches[i];
    stretch.first = static_cast<std::int16_t>((stretch.first + other.first) / 2);
    stretch.end = static_cast<std::int16_t>((stretch.end + other.end + 1) / 2);
    const bool overlaps = i > 0 && stretch.first <= middle.stretches[i - 1].end;
    if (stretch.atOne != other.atOne || overlaps) {
      return a;
    }
  }
  return middle;
}

double roughness(const Eigen::VectorXd& spectrum) {
  return (spectrum.tail(spectrum.size() - 1) - spectrum.head(spectrum.size() - 1)).squaredNorm();
}

SmoothestSpectrumSolver::SmoothestSpectrumSolver(Eigen::Matrix3Xd weights, UpperBound upperBound)
    : m_weights(std::move(weights)), m_upperBound(upperBound) {
  assert(bandCount() >= kMinimumBandCount && bandCount() <= kConvergedBandCount);
  m_table = std::make_shared<const BandTable>(m_weights);
  BandStates free;
  free.fill(BandState::Free);
  m_unconstrained = ReducedSystem(*m_table, free, nullptr, ReducedSystem::Held::AtBounds).response();
  // One step of refinement: what the constraints miss changes the roughness to first order, all else to second.
  m_unconstrained += (m_unconstrained * (Eigen::Matrix3d::Identity() - m_weights * m_unconstrained)).eval();
}

std::optional<SmoothestSpectrumSolver::Solution> SmoothestSpectrumSolver::solve(const Eigen::Vector3d& tristimulus,
                                                                                const Eigen::VectorXd* prior,
                                                                                const ActiveSet* start,
                                                                                Eigen::MatrixX3d* linearPiece) const {
  Solution solution;
  Eigen::VectorXd& spectrum = solution.reflectance;
  Guide guide;
  if (prior != nullptr) {
    guide.values = *prior;
  }
  const Problem problem{*m_table, m_upperBound == UpperBound::One, tristimulus, prior != nullptr ? &guide : nullptr};
  BandStates states;
  bool settled = false;
  if (start != nullptr && !start->empty()) {
    states = statesOf(*start);
    settled = forceAndRelease(problem, states, spectrum, solution.rounds, linearPiece);
    solution.active = activeSetOf(states, bandCount());
    // With nothing held the answer is the one below, to the last bit.
    settled = settled && !solution.active.empty();
  }
  if (!settled) {
    spectrum = m_unconstrained * tristimulus;
    if (prior != nullptr) {
      spectrum += *prior - m_unconstrained * (m_weights * *prior);
    }
    if (linearPiece != nullptr) {
      *linearPiece = m_unconstrained;
    }
    states.fill(BandState::Free);
    if (!force(problem, spectrum, states)) {
      const Eigen::VectorXd relaxed = spectrum;
      if (!forceAndRelease(problem, states, spectrum, solution.rounds, linearPiece)) {
        solution.fellBack = true;
        spectrum = relaxed;
        if (!dualActiveSet(problem, spectrum, states, solution.rounds, linearPiece)) {
          return std::nullopt;
        }
      }
    }
    solution.active = activeSetOf(states, bandCount());
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
  const Problem problem{*m_table, false, tristimulus, nullptr};
  BandStates states;
  states.fill(BandState::Free);
  Eigen::Vector3d multipliers;
  const double tolerance = toleranceOf(solution.reflectance);
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
