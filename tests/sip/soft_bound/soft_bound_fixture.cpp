// SPDX-License-Identifier: Apache-2.0
#include "sip/soft_bound/soft_bound_fixture.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "sip/sip_fixture.h"

namespace metamer::sip {

using Eigen::Vector3d;

std::vector<Vector3d> everyTristimulus(const SoftBoundSolver& solver, int count, unsigned seed) {
  std::vector<Vector3d> made = feasibleTristimuli(solver.weights(), count / 2, seed);
  std::mt19937 random(seed + 1);
  while (static_cast<int>(made.size()) < count) {
    const std::size_t kind = made.size() % 5;
    const Vector3d any = 2.0 * Vector3d(unitRandom(random), unitRandom(random), unitRandom(random)) - Vector3d::Ones();
    const Vector3d feasible = made[made.size() / 7];
    if (kind == 0) {
      made.push_back(any);
    } else if (kind == 1) {
      made.emplace_back(-feasible);
    } else if (kind == 2) {
      made.emplace_back(Vector3d(any.x(), 1e-6 * any.y(), any.z()));
    } else if (kind == 3) {
      made.emplace_back(feasible + 1e-9 * any);
    } else {
      // On the way from white to a colour far outside, where the first band reaches zero.
      const BandVector white = solver.unclamped() * Vector3d::Ones();
      const BandVector slope = solver.unclamped() * any;
      double share = 1.0;
      for (Eigen::Index b = 0; b < slope.size(); ++b) {
        if (slope[b] < 0.0) {
          share = std::min(share, white[b] / -slope[b]);
        }
      }
      made.emplace_back(Vector3d::Ones() + share * any);
    }
  }
  return made;
}

BandVector randomPrior(const SoftBoundSolver& solver, std::mt19937& random, double size) {
  const Eigen::Index bands = solver.bandCount();
  BandVector spectrum = BandVector::Zero(bands);
  for (int wave = 1; wave <= 8; ++wave) {
    const double height = 2.0 * unitRandom(random) - 1.0;
    const double phase = 2.0 * std::numbers::pi * unitRandom(random);
    for (Eigen::Index b = 0; b < bands; ++b) {
      spectrum[b] +=
          size * height *
          std::sin(phase + std::numbers::pi * wave * static_cast<double>(b) / static_cast<double>(bands - 1));
    }
  }
  const Vector3d response = solver.weights() * spectrum;
  return spectrum - solver.unclamped() * response;
}

Optimality optimalityOf(const SoftBoundSolver& solver, double relaxation, const BandVector& spectrum,
                        const Vector3d& tristimulus, const BandVector* prior) {
  const Eigen::Index bands = spectrum.size();
  const Eigen::Matrix3Xd& weights = solver.weights();
  const double bandNm = 400.0 / static_cast<double>(bands - 1);
  const Eigen::VectorXd deviation = prior != nullptr ? Eigen::VectorXd(spectrum - *prior) : Eigen::VectorXd(spectrum);
  Eigen::VectorXd bend = Eigen::VectorXd::Zero(bands);
  for (Eigen::Index b = 0; b + 1 < bands; ++b) {
    const double difference = deviation[b + 1] - deviation[b];
    bend[b] -= difference;
    bend[b + 1] += difference;
  }
  const double price = 0.2 * bandNm * bandNm;
  const Eigen::VectorXd gradient = bend + price * Eigen::VectorXd(spectrum.cwiseMin(0.0));
  const double size = std::max({spectrum.cwiseAbs().maxCoeff(), deviation.cwiseAbs().maxCoeff(), 1e-300});
  // What rounding leaves of a gradient goes by what is multiplied in it.
  const double gradientSize = size * std::max({1.0, price, relaxation});
  Optimality result;
  if (relaxation > 0.0) {
    const Vector3d multipliers = relaxation * (tristimulus - weights * deviation);
    result.gradient = (gradient - weights.transpose() * multipliers).cwiseAbs().maxCoeff() / gradientSize;
    return result;
  }
  const Eigen::VectorXd multipliers = Eigen::MatrixXd(weights.transpose()).colPivHouseholderQr().solve(gradient);
  result.gradient = (gradient - weights.transpose() * multipliers).cwiseAbs().maxCoeff() / gradientSize;
  result.missed = (weights * spectrum - tristimulus).norm() / std::max(size, tristimulus.norm());
  return result;
}

}  // namespace metamer::sip
