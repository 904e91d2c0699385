// SPDX-License-Identifier: Apache-2.0
#include "pairs/several_lights.h"

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>

namespace metamer::sip {

namespace {

using Eigen::ArrayXd;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kMostSteps = 120;
/// Part of the way to a bound that a step may go.
constexpr double kShort = 0.995;
/// What bounds give way by, so that a colour that only a bound makes, white, has room round it.
constexpr double kRoom = 1e-10;
constexpr double kLeastBarrier = 1e-16;
/// Equations that others imply to this part of the strongest one are those others.
constexpr double kImplied = 1e-10;
/// Price of roughness beside misses, where colours cannot all be met.
constexpr double kRoughness = 1e-9;

MatrixXd roughness(Index bands) {
  MatrixXd matrix = MatrixXd::Zero(bands, bands);
  for (Index b = 0; b + 1 < bands; ++b) {
    matrix.block<2, 2>(b, b) += (Eigen::Matrix2d() << 1, -1, -1, 1).finished();
  }
  return matrix;
}

/// Minimises `R' quadratic R / 2 - linear' R` subject to `rows * R = values` and the bounds.
VectorXd interiorPoint(const MatrixXd& quadratic, const VectorXd& linear, const MatrixXd& rows, const VectorXd& values,
                       double brightest) {
  const Index bands = quadratic.rows();
  const double low = -kRoom;
  const double high = brightest + kRoom;
  VectorXd x = VectorXd::Constant(bands, 0.5);
  VectorXd prices = VectorXd::Zero(rows.rows());
  ArrayXd below = ArrayXd::Ones(bands);  // multipliers of the bounds
  ArrayXd above = ArrayXd::Ones(bands);
  for (int step = 0; step < kMostSteps; ++step) {
    const ArrayXd toLow = x.array() - low;
    const ArrayXd toHigh = high - x.array();
    const double gap = ((toLow * below).sum() + (toHigh * above).sum()) / static_cast<double>(2 * bands);
    const VectorXd missed = values - rows * x;
    if (gap < kLeastBarrier && (rows.rows() == 0 || missed.cwiseAbs().maxCoeff() < 1e-13)) {
      break;
    }
    const double barrier = 0.1 * gap;
    const MatrixXd system = quadratic + MatrixXd((below / toLow + above / toHigh).matrix().asDiagonal());
    const VectorXd force =
        linear - quadratic * x + rows.transpose() * prices + (barrier / toLow - barrier / toHigh).matrix();
    const Eigen::LLT<MatrixXd> factored(system);
    VectorXd move = factored.solve(force);
    VectorXd priceStep = VectorXd::Zero(rows.rows());
    if (rows.rows() > 0) {
      const MatrixXd spread = factored.solve(rows.transpose());
      priceStep = (rows * spread).eval().completeOrthogonalDecomposition().solve(missed - rows * move);
      move += spread * priceStep;
    }
    const ArrayXd belowStep = barrier / toLow - below - below / toLow * move.array();
    const ArrayXd aboveStep = barrier / toHigh - above + above / toHigh * move.array();
    double length = 1.0;
    double dualLength = 1.0;
    for (Index b = 0; b < bands; ++b) {
      if (move[b] < 0.0) {
        length = std::min(length, -kShort * toLow[b] / move[b]);
      } else if (move[b] > 0.0) {
        length = std::min(length, kShort * toHigh[b] / move[b]);
      }
      if (belowStep[b] < 0.0) {
        dualLength = std::min(dualLength, -kShort * below[b] / belowStep[b]);
      }
      if (aboveStep[b] < 0.0) {
        dualLength = std::min(dualLength, -kShort * above[b] / aboveStep[b]);
      }
    }
    x += length * move;
    prices += dualLength * priceStep;
    below += dualLength * belowStep;
    above += dualLength * aboveStep;
  }
  return x.cwiseMax(0.0).cwiseMin(brightest);
}

}  // namespace

SeveralLights smoothestUnder(const MatrixXd& weights, const VectorXd& colours, double brightest) {
  const Index bands = weights.cols();
  const auto missed = [&](const VectorXd& reflectance) {
    return (weights * reflectance - colours).cwiseAbs().maxCoeff();
  };
  // Independent combinations of the equations.
  const Eigen::JacobiSVD<MatrixXd> svd(weights, Eigen::ComputeThinU | Eigen::ComputeThinV);
  const Index rank = (svd.singularValues().array() > kImplied * svd.singularValues()[0]).count();
  const MatrixXd rows = svd.matrixV().leftCols(rank).transpose();
  const VectorXd values =
      (svd.matrixU().leftCols(rank).transpose() * colours).cwiseQuotient(svd.singularValues().head(rank));
  const VectorXd smoothest = interiorPoint(roughness(bands), VectorXd::Zero(bands), rows, values, brightest);
  if (const double off = missed(smoothest); off <= kMetColour) {
    return {smoothest, off};
  }
  const MatrixXd misses = weights.transpose() * weights + kRoughness * roughness(bands);
  const VectorXd nearest =
      interiorPoint(misses, weights.transpose() * colours, MatrixXd(0, bands), VectorXd(0), brightest);
  return {nearest, missed(nearest)};
}

}  // namespace metamer::sip
