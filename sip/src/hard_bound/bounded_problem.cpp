// SPDX-License-Identifier: Apache-2.0
#include "hard_bound/bounded_problem.h"

namespace metamer::sip {

namespace {

/// A band this far below its bound, relative to the spectrum's largest value, still counts as on it.
constexpr double kBoundTolerance = 1e-12;
/// Constraint residual, relative to the target, that a solution may keep (rounding near the spectral locus).
constexpr double kResidualTolerance = 1e-9;

}  // namespace

bool BoundedProblem::meets(const Eigen::VectorXd& spectrum) const {
  return (table.sumOf(spectrum) - target).norm() <= kResidualTolerance * target.norm();
}

double toleranceOf(const Eigen::VectorXd& spectrum) {
  return kBoundTolerance * spectrum.cwiseAbs().maxCoeff();
}

bool conclude(const BoundedProblem& problem, const ReducedSystem& system, Trial& trial, Linearised* linearised) {
  if (linearised != nullptr) {
    linearised->matrix = system.response(linearised->functionals);
    if (problem.meets(trial.spectrum)) {
      return true;
    }
  }
  system.refine(problem.target, trial);
  return problem.meets(trial.spectrum);
}

}  // namespace metamer::sip
