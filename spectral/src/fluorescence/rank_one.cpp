// SPDX-License-Identifier: Apache-2.0
#include "fluorescence/rank_one.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace metamer::spectral {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// How far lights are alike, and how much of them is not: a line.
constexpr double kLightNm = 30;
constexpr double kLines = 0.05;
constexpr int kRounds = 40;
constexpr int kSweeps = 10;

/// Some sweeps of coordinate descent towards the least of x' A x / 2 - b' x, from 0 to the most.
void descend(const MatrixXd& a, const VectorXd& b, const VectorXd& most, VectorXd& x) {
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    for (Index k = 0; k < x.size(); ++k) {
      if (a(k, k) > 0) {
        x[k] = std::clamp(x[k] + (b[k] - a.row(k).dot(x)) / a(k, k), 0.0, most[k]);
      }
    }
  }
}

}  // namespace

RankOne nearestRankOne(const ShiftedFactors& shifted) {
  constexpr int kMostRounds = 2000;
  constexpr double kSettled = 1e-12;
  const MatrixXd& factors = shifted.factors;
  // Sums of what is not negative are not negative.
  RankOne fit{VectorXd::Zero(factors.rows()), factors.colwise().sum().transpose()};
  double before = 0;
  for (int round = 0; round < kMostRounds; ++round) {
    const auto over = [](const VectorXd& sum, const VectorXd& weight) {
      return (weight.array() > 0).select(sum.array() / weight.array(), 0.0).matrix();
    };
    fit.emission = over(factors * fit.excitation, shifted.is * fit.excitation.cwiseAbs2());
    fit.excitation = over(factors.transpose() * fit.emission, shifted.is.transpose() * fit.emission.cwiseAbs2());
    const double left = (factors - (fit.emission * fit.excitation.transpose()).cwiseProduct(shifted.is)).squaredNorm();
    if (std::abs(before - left) <= kSettled * factors.squaredNorm()) {
      break;
    }
    before = left;
  }
  return fit;
}

RankOne nearestAsSeen(const ShiftedFactors& shifted, const RankOne& from, const PhotonBounds& bounds,
                      const Eigen::MatrixX3d& curves, double unseen) {
  const Index emissions = shifted.factors.rows();
  const Index excitations = shifted.factors.cols();
  const MatrixXd sights = curves * curves.transpose() + unseen * MatrixXd::Identity(emissions, emissions);
  MatrixXd lights = kLines * MatrixXd::Identity(excitations, excitations);
  for (Index i = 0; i < excitations; ++i) {
    for (Index j = 0; j < excitations; ++j) {
      lights(i, j) += std::exp(-std::abs(static_cast<double>(i - j)) * bounds.stepNm / kLightNm);
    }
  }
  const MatrixXd seen = sights * shifted.factors * lights;
  const VectorXd any = VectorXd::Constant(emissions, std::numeric_limits<double>::max());
  RankOne fit = from;
  const auto scale = [&] {
    if (const double photons = bounds.photons.dot(fit.emission); photons > 0) {
      fit.emission /= photons;
      fit.excitation = (photons * fit.excitation).cwiseMin(bounds.excitation).eval();
    }
  };
  scale();
  for (int round = 0; round < kRounds; ++round) {
    const MatrixXd byEmission = shifted.is * fit.excitation.asDiagonal();
    descend((byEmission * lights * byEmission.transpose()).cwiseProduct(sights),
            byEmission.cwiseProduct(seen).rowwise().sum(), any, fit.emission);
    scale();
    const MatrixXd byExcitation = fit.emission.asDiagonal() * shifted.is;
    descend((byExcitation.transpose() * sights * byExcitation).cwiseProduct(lights),
            byExcitation.cwiseProduct(seen).colwise().sum().transpose(), bounds.excitation, fit.excitation);
  }
  return fit;
}

}  // namespace metamer::spectral
