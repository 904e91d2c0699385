// SPDX-License-Identifier: Apache-2.0
// A shim to an internal of the engine, the solver behind a transform, so that quadratic programming libraries can judge
// it on the same numbers: rounds, fall-backs and the course notes' loop are no part of the Python package.
#include <algorithm>
#include <chrono>

#include "metamer/sip/smoothest_spectrum.h"

using metamer::sip::SmoothestSpectrumSolver;

namespace {
SmoothestSpectrumSolver solverFor(const double* weights, int bandCount, bool bounded) {
  return SmoothestSpectrumSolver(
      Eigen::Map<const Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::RowMajor>>(weights, 3, bandCount),
      bounded ? SmoothestSpectrumSolver::UpperBound::One : SmoothestSpectrumSolver::UpperBound::None);
}
}  // namespace

/// Solves `count` problems. weights: 3 x bandCount rows; tristimuli: count x 3 rows; prior: bandCount values or null;
/// spectra: count x bandCount rows out; rounds: one a problem, -1 where infeasible, + 1000 where the dual method ran.
/// @return seconds spent in the solves
extern "C" double metamerSolve(const double* weights, int bandCount, int bounded, const double* tristimuli, int count,
                               const double* prior, double* spectra, int* rounds) {
  const SmoothestSpectrumSolver solver = solverFor(weights, bandCount, bounded != 0);
  Eigen::VectorXd priorValues;
  if (prior != nullptr) {
    priorValues = Eigen::Map<const Eigen::VectorXd>(prior, bandCount);
  }
  const auto start = std::chrono::steady_clock::now();
  for (int i = 0; i < count; ++i) {
    const auto solution =
        solver.solve(Eigen::Map<const Eigen::Vector3d>(tristimuli + 3 * i), prior != nullptr ? &priorValues : nullptr);
    rounds[i] = solution ? solution->rounds + (solution->fellBack ? 1000 : 0) : -1;
    if (solution) {
      std::copy_n(solution->reflectance.data(), bandCount, spectra + static_cast<std::ptrdiff_t>(i) * bandCount);
    }
  }
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// The course notes' loop on the same problems; rounds is -1 where it ends without a spectrum.
extern "C" void metamerSolveByForcingOnly(const double* weights, int bandCount, const double* tristimuli, int count,
                                          double* spectra, int* rounds) {
  const SmoothestSpectrumSolver solver = solverFor(weights, bandCount, false);
  for (int i = 0; i < count; ++i) {
    const auto solution = solver.solveByForcingOnly(Eigen::Map<const Eigen::Vector3d>(tristimuli + 3 * i));
    rounds[i] = solution ? solution->rounds : -1;
    if (solution) {
      std::copy_n(solution->reflectance.data(), bandCount, spectra + static_cast<std::ptrdiff_t>(i) * bandCount);
    }
  }
}
