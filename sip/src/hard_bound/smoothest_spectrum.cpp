// SPDX-License-Identifier: Apache-2.0
#include "metamer/sip/smoothest_spectrum.h"

#include <algorithm>

#include "hard_bound/band_table.h"
#include "hard_bound/bounded_problem.h"
#include "hard_bound/dual_active_set.h"
#include "hard_bound/force_and_release.h"
#include "metamer/sip/band_weights.h"
#include "metamer/spectral/argument_checks.h"
#include "metamer/spectral/input_error.h"

namespace metamer::sip {

namespace {

/// How a solve ended.
struct Outcome {
  Trial trial;
  ActiveSet active;
  int rounds = 0;
  bool fellBack = false;
};

/// Solves; nothing where no spectrum within the bounds has the target. With nothing held, `linearised` is left to the
/// caller.
/// @param relax  makes the answer without bounds
template <typename Relax>
std::optional<Outcome> settle(const BoundedProblem& problem, const ActiveSet* start, const Relax& relax,
                              Linearised* linearised) {
  Outcome outcome;
  BandStates states{};
  if (start != nullptr && !start->empty()) {
    states = statesOf(*start);
    if (forceAndRelease(problem, states, outcome.trial, outcome.rounds, linearised)) {
      outcome.active = activeSetOf(states, problem.bandCount);
      // With nothing held the answer is the one below, to the last bit.
      if (!outcome.active.empty()) {
        return outcome;
      }
    }
  }
  outcome.trial.spectrum = relax();
  states.fill(BandState::Free);
  if (!force(problem, outcome.trial.spectrum, states)) {
    if (!forceAndRelease(problem, states, outcome.trial, outcome.rounds, linearised)) {
      outcome.fellBack = true;
      outcome.trial.spectrum = relax();
      if (!dualActiveSet(problem, states, outcome.trial, outcome.rounds, linearised)) {
        return std::nullopt;
      }
    }
  }
  outcome.active = activeSetOf(states, problem.bandCount);
  return outcome;
}

}  // namespace

double roughness(const Eigen::VectorXd& spectrum) {
  return (spectrum.tail(spectrum.size() - 1) - spectrum.head(spectrum.size() - 1)).squaredNorm();
}

SmoothestSpectrumSolver::SmoothestSpectrumSolver(Eigen::Matrix3Xd weights, UpperBound upperBound)
    : m_weights(std::move(weights)), m_upperBound(upperBound) {
  spectral::requireWithin("bands of the weights", bandCount(), kFewestBands, kConvergedBandCount);
  m_table = std::make_shared<const BandTable>(m_weights);
  const BandStates free{};
  m_unconstrained = ReducedSystem(*m_table, free, nullptr, ReducedSystem::Held::AtBounds).response();
  // One step of refinement: what the constraints miss changes the roughness to first order, all else to second.
  m_unconstrained += (m_unconstrained * (Eigen::Matrix3d::Identity() - m_weights * m_unconstrained)).eval();
}

std::optional<SmoothestSpectrumSolver::Solution> SmoothestSpectrumSolver::solve(const Eigen::Vector3d& tristimulus,
                                                                                const Eigen::VectorXd* prior,
                                                                                const ActiveSet* start) const {
  Guide guide;
  if (prior != nullptr) {
    spectral::requireAsMany("prior", prior->size(), "the bands", bandCount());
    guide.values = *prior;
  }
  const auto relax = [&] {
    Eigen::VectorXd relaxed = m_unconstrained * tristimulus;
    if (prior != nullptr) {
      relaxed += *prior - m_unconstrained * (m_weights * *prior);
    }
    return relaxed;
  };
  const BoundedProblem problem{*m_table, m_upperBound == UpperBound::One, tristimulus,
                               prior != nullptr ? &guide : nullptr};
  std::optional<Outcome> outcome = settle(problem, start, relax, nullptr);
  if (!outcome) {
    return std::nullopt;
  }
  Solution solution{std::move(outcome->trial.spectrum), std::move(outcome->active), outcome->rounds, outcome->fellBack};
  // What lies beyond a bound by rounding alone is put on it.
  solution.reflectance = solution.reflectance.cwiseMax(0.0);
  if (problem.bounded) {
    solution.reflectance = solution.reflectance.cwiseMin(1.0);
  }
  return solution;
}

std::optional<SmoothestSpectrumSolver::LinearPiece> SmoothestSpectrumSolver::linearise(
    const Eigen::Vector3d& tristimulus, const Eigen::MatrixX3d& functionals, const ActiveSet* start) const {
  if (m_upperBound != UpperBound::None) {
    throw spectral::InputError("", "upper bound", "", "a linear piece is of a solver without one");
  }
  spectral::requireAsMany("functionals", functionals.rows(), "the bands", bandCount());
  const BoundedProblem problem{*m_table, false, tristimulus, nullptr};
  Linearised linearised{functionals, Eigen::Matrix3d::Zero()};
  const auto relax = [&]() -> Eigen::VectorXd { return m_unconstrained * tristimulus; };
  std::optional<Outcome> outcome = settle(problem, start, relax, &linearised);
  if (!outcome) {
    return std::nullopt;
  }
  if (outcome->active.empty()) {
    linearised.matrix = functionals.transpose() * m_unconstrained;
  }
  return LinearPiece{std::move(outcome->active), linearised.matrix};
}

std::optional<SmoothestSpectrumSolver::Solution> SmoothestSpectrumSolver::solveByForcingOnly(
    const Eigen::Vector3d& tristimulus) const {
  Solution solution;
  solution.reflectance = m_unconstrained * tristimulus;
  const BoundedProblem problem{*m_table, false, tristimulus, nullptr};
  BandStates states{};
  Trial trial;
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
    system.solve(tristimulus, trial);
    system.refine(tristimulus, trial);
    solution.reflectance = trial.spectrum;
  }
  return std::nullopt;
}

}  // namespace metamer::sip
