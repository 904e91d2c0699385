// SPDX-License-Identifier: Apache-2.0
#include "metamer/stage/emitter_selection.h"

#include <Eigen/QR>
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "metamer/spectral/argument_checks.h"
#include "metamer/spectral/input_error.h"

namespace metamer::stage {
namespace {

using spectral::InputError;

/// A case by as many rows as emitters, which hold all that subsets can change.
struct ReducedCase {
  Eigen::MatrixXd matrix;
  Eigen::VectorXd target;
  double constant = 0;  ///< squared part of the target that no emitter reaches
  double size = 0;      ///< squared target
};

ReducedCase reduced(const MatchSystem& system) {
  const Eigen::Index count = system.matrix.cols();
  ReducedCase result;
  result.size = system.target.squaredNorm();
  if (system.matrix.rows() <= count) {
    result.matrix = system.matrix;
    result.target = system.target;
    return result;
  }
  const Eigen::HouseholderQR<Eigen::MatrixXd> factors(system.matrix);
  const Eigen::VectorXd rotated = factors.householderQ().transpose() * system.target;
  result.matrix = factors.matrixQR().topRows(count).triangularView<Eigen::Upper>();
  result.target = rotated.head(count);
  result.constant = rotated.tail(rotated.size() - count).squaredNorm();
  return result;
}

std::vector<int> emittersOf(unsigned subset, int count) {
  std::vector<int> emitters;
  for (int k = 0; k < count; ++k) {
    if ((subset >> k & 1U) != 0) {
      emitters.push_back(k);
    }
  }
  return emitters;
}

EmitterChoice judged(const std::vector<ReducedCase>& cases, std::vector<int> emitters) {
  EmitterChoice choice;
  double sum = 0;
  for (const ReducedCase& one : cases) {
    Eigen::MatrixXd matrix(one.matrix.rows(), static_cast<Eigen::Index>(emitters.size()));
    for (std::size_t k = 0; k < emitters.size(); ++k) {
      matrix.col(static_cast<Eigen::Index>(k)) = one.matrix.col(emitters[k]);
    }
    const double residual = nonNegativeLeastSquares(matrix, one.target).residualNorm;
    const double relative = (residual * residual + one.constant) / one.size;
    choice.caseResiduals.push_back(std::sqrt(relative));
    sum += relative;
  }
  choice.emitters = std::move(emitters);
  choice.error = std::sqrt(sum / static_cast<double>(cases.size()));
  return choice;
}

}  // namespace

std::vector<EmitterChoice> selectEmitters(const std::vector<SelectionCase>& cases, const std::vector<int>& required,
                                          int most, const std::function<void(double)>& progress) {
  if (cases.empty()) {
    throw InputError("", "targets", "", "are none; name at least one light");
  }
  const auto count = static_cast<int>(cases.front().system.matrix.cols());
  if (count < 1 || count > kMostSelectable) {
    throw InputError("", "emitters", std::to_string(count),
                     "must be 1 to " + std::to_string(kMostSelectable) + ": every subset is tried");
  }
  std::vector<ReducedCase> reducedCases;
  for (const SelectionCase& one : cases) {
    spectral::requireAsMany("emitters of a target", one.system.matrix.cols(), "the first has", count);
    spectral::requireAsMany("target", one.system.target.size(), "the rows of the matrix", one.system.matrix.rows());
    if (!(one.system.target.norm() > 0)) {
      throw InputError("", "target", one.name, "holds no light");
    }
    reducedCases.push_back(reduced(one.system));
  }
  unsigned kept = 0;
  spectral::requireWithin("most", most, 0, std::numeric_limits<int>::max());
  for (const int emitter : required) {
    spectral::requireWithin("required emitter", emitter, 0, count - 1);
    kept |= 1U << emitter;
  }
  const int fewest = std::max(1, std::popcount(kept));
  const int largest = std::max(fewest, most > 0 ? std::min(most, count) : count);
  std::vector<EmitterChoice> best(static_cast<std::size_t>(largest - fewest + 1));
  for (EmitterChoice& choice : best) {
    choice.error = std::numeric_limits<double>::infinity();
  }
  const unsigned subsets = 1U << count;
  for (unsigned subset = 1; subset < subsets; ++subset) {
    const int size = std::popcount(subset);
    if ((subset & kept) == kept && size >= fewest && size <= largest) {
      EmitterChoice choice = judged(reducedCases, emittersOf(subset, count));
      EmitterChoice& champion = best[static_cast<std::size_t>(size - fewest)];
      if (choice.error < champion.error) {
        champion = std::move(choice);
      }
    }
    if (progress && subset % 64 == 0) {
      progress(static_cast<double>(subset) / subsets);
    }
  }
  return best;
}

}  // namespace metamer::stage
