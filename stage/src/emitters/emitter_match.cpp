// SPDX-License-Identifier: Apache-2.0
#include "metamer/stage/emitter_match.h"

#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>

#include "metamer/spectral/argument_checks.h"
#include "metamer/spectral/input_error.h"
#include "metamer/spectral/text.h"

namespace metamer::stage {
namespace {

using spectral::InputError;

/// Relative weights of nearly black values would be all there is.
constexpr double kSmallestRelative = 0.01;

/// Divides each row by its target.
void makeRelative(MatchSystem& system) {
  const double floor = kSmallestRelative * system.target.cwiseAbs().maxCoeff();
  for (Eigen::Index row = 0; row < system.target.size(); ++row) {
    const double weight = 1 / std::max(std::abs(system.target[row]), std::max(floor, 1e-300));
    system.matrix.row(row) *= weight;
    system.target[row] *= weight;
  }
}

double levelOf(const spectral::DomainSamples& target, const ObserverCurves& curves) {
  const double level = curves.col(1).dot(target);
  if (!(level > 0)) {
    throw InputError("", "target", "", "gives this observer no light; check the target and the observer");
  }
  return level;
}

}  // namespace

MatchMethod matchMethodFromName(const std::string& name) {
  const std::string lower = spectral::lowerCase(name);
  if (lower == "sim") {
    return MatchMethod::Spectral;
  }
  if (lower == "mim") {
    return MatchMethod::MetamericIlluminant;
  }
  if (lower == "mrm") {
    return MatchMethod::MetamericReflectance;
  }
  throw InputError("", "method", name, "must be sim, mim or mrm");
}

MatchSystem spectralSystem(const EmitterColumns& emitters, const spectral::DomainSamples& target) {
  return {emitters, target};
}

MatchSystem illuminantSystem(const EmitterColumns& emitters, const spectral::DomainSamples& target,
                             const ObserverCurves& curves) {
  const double level = levelOf(target, curves);
  return {curves.transpose() * emitters / level, curves.transpose() * target / level};
}

MatchSystem reflectanceSystem(const EmitterColumns& emitters, const spectral::DomainSamples& target,
                              const ObserverCurves& curves, const std::vector<spectral::DomainSamples>& reflectances,
                              MatchWeights weights) {
  if (reflectances.empty()) {
    throw InputError("", "reflectances", "0", "are none; name a set");
  }
  const double level = levelOf(target, curves);
  const auto count = static_cast<Eigen::Index>(reflectances.size());
  MatchSystem system{Eigen::MatrixXd(3 * count, emitters.cols()), Eigen::VectorXd(3 * count)};
  for (Eigen::Index i = 0; i < count; ++i) {
    const ObserverCurves seen = (reflectances[static_cast<std::size_t>(i)] / level).asDiagonal() * curves;
    system.matrix.middleRows<3>(3 * i) = seen.transpose() * emitters;
    system.target.segment<3>(3 * i) = seen.transpose() * target;
  }
  if (weights == MatchWeights::Relative) {
    makeRelative(system);
  }
  return system;
}

MatchSystem chartSystem(const std::vector<Eigen::Matrix3Xd>& charts, const Eigen::Matrix3Xd& target,
                        MatchWeights weights) {
  if (target.cols() == 0) {
    throw InputError("", "charts", "0 patches", "are empty; a chart has at least one patch");
  }
  for (const Eigen::Matrix3Xd& chart : charts) {
    spectral::requireAsMany("patches of an emitter's chart", chart.cols(), "the target has", target.cols());
  }
  MatchSystem system{Eigen::MatrixXd(target.size(), static_cast<Eigen::Index>(charts.size())), target.reshaped()};
  for (std::size_t k = 0; k < charts.size(); ++k) {
    system.matrix.col(static_cast<Eigen::Index>(k)) = charts[k].reshaped();
  }
  if (weights == MatchWeights::Relative) {
    makeRelative(system);
  }
  return system;
}

MatchSystem together(const MatchSystem& first, const MatchSystem& second, double weight) {
  spectral::requireAsMany("emitters", second.matrix.cols(), "the first system's", first.matrix.cols());
  spectral::requireWithin("weight", weight, 0, std::numeric_limits<double>::max());
  MatchSystem both{Eigen::MatrixXd(first.matrix.rows() + second.matrix.rows(), first.matrix.cols()),
                   Eigen::VectorXd(first.target.size() + second.target.size())};
  both.matrix << first.matrix, std::sqrt(weight) * second.matrix;
  both.target << first.target, std::sqrt(weight) * second.target;
  return both;
}

MatchSystem condensed(const MatchSystem& system) {
  const Eigen::Index emitters = system.matrix.cols();
  if (system.matrix.rows() <= emitters + 1) {
    return system;
  }
  Eigen::MatrixXd both(system.matrix.rows(), emitters + 1);
  both << system.matrix, system.target;
  const Eigen::HouseholderQR<Eigen::MatrixXd> factors(both);
  const Eigen::MatrixXd triangle = factors.matrixQR().topRows(emitters + 1).triangularView<Eigen::Upper>();
  return {triangle.leftCols(emitters), triangle.col(emitters)};
}

EmitterMatch solveMatch(const MatchSystem& system, const DriveLimits& limits) {
  if (system.matrix.cols() == 0 || system.matrix.cols() > kMostDrives) {
    throw InputError("", "emitters", std::to_string(system.matrix.cols()),
                     "must be 1 to " + std::to_string(kMostDrives));
  }
  spectral::requireAsMany("target", system.target.size(), "the rows of the matrix", system.matrix.rows());
  if (!(system.target.norm() > 0)) {
    throw InputError("", "target", "", "holds no light; check the target");
  }
  const Eigen::VectorXd lengths = system.matrix.colwise().norm();
  EmitterMatch match;
  for (Eigen::Index k = 0; k < lengths.size(); ++k) {
    if (!(lengths[k] > 0)) {
      match.deadEmitters.push_back(static_cast<int>(k));
    }
  }
  if (match.deadEmitters.size() == static_cast<std::size_t>(lengths.size())) {
    throw InputError("", "emitters", "", "give no light at all; check their spectra");
  }
  const LeastSquaresSolution solution = nonNegativeLeastSquares(system.matrix, system.target, limits);
  match.drives = solution.x;
  match.rank = solution.rank;
  match.residualNorm = solution.residualNorm;
  match.relativeResidual = solution.residualNorm / system.target.norm();
  const Eigen::MatrixXd unit =
      system.matrix * lengths.unaryExpr([](double l) { return l > 0 ? 1 / l : 0.0; }).asDiagonal();
  const Eigen::VectorXd sizes = Eigen::JacobiSVD<Eigen::MatrixXd>(unit).singularValues();
  const bool isFull = match.rank == system.matrix.cols() && sizes[sizes.size() - 1] > 0;
  match.condition = isFull ? sizes[0] / sizes[sizes.size() - 1] : std::numeric_limits<double>::infinity();
  return match;
}

}  // namespace metamer::stage
