// SPDX-License-Identifier: Apache-2.0
#include "uplift/jakob_solver.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace metamer::spectral {
namespace {

/// A difference below which a colour counts as met.
constexpr double kMet = 1e-7;
/// One above which other places are tried: less is never seen.
constexpr double kLeft = 1e-3;
constexpr int kMostSteps = 60;

/// U of a flat spectrum.
double flat(double reflectance) {
  const double s = 2 * std::clamp(reflectance, 1e-6, 1 - 1e-6) - 1;
  return s / std::sqrt(1 - s * s);
}

}  // namespace

std::vector<double> JakobSolver::wavelengthsNm() {
  std::vector<double> wavelengths(kBands);
  for (int i = 0; i < kBands; ++i) {
    wavelengths[static_cast<std::size_t>(i)] = kDomainStartNm + 5.0 * i;
  }
  return wavelengths;
}

JakobSolver::JakobSolver(const UpliftWeights& weights) : m_white(weights.colwise().sum().transpose()) {
  m_weights.setZero();
  for (int i = 0; i < kRows; ++i) {
    m_t[i] = i / static_cast<double>(kBands - 1);
  }
  const auto t = m_t.head<kBands>().matrix().asDiagonal();
  m_weights.block<kBands, 3>(0, 6) = weights;
  m_weights.block<kBands, 3>(0, 3) = t * weights;
  m_weights.block<kBands, 3>(0, 0) = t * (t * weights);
}

void JakobSolver::spectrum(const Eigen::Vector3d& coefficients, double* values) const {
  const Rows u = (coefficients[0] * m_t + coefficients[1]) * m_t + coefficients[2];
  const Rows reflectance = 0.5 + 0.5 * u / (1 + u * u).sqrt();
  std::copy_n(reflectance.data(), kBands, values);
}

Eigen::Vector3d JakobSolver::labOf(const Eigen::Vector3d& xyz, Eigen::Vector3d* slopes) const {
  Eigen::Vector3d f;
  for (int k = 0; k < 3; ++k) {
    const double ratio = xyz[k] / m_white[k];
    if (ratio > 216.0 / 24389) {
      f[k] = std::cbrt(ratio);
      if (slopes != nullptr) {
        (*slopes)[k] = f[k] / (3 * xyz[k]);
      }
    } else {
      f[k] = (841.0 / 108) * ratio + 4.0 / 29;
      if (slopes != nullptr) {
        (*slopes)[k] = (841.0 / 108) / m_white[k];
      }
    }
  }
  return {116 * f[1] - 16, 500 * (f[0] - f[1]), 200 * (f[1] - f[2])};
}

JakobSolver::State JakobSolver::stateAt(const Eigen::Vector3d& coefficients, const Eigen::Vector3d& targetLab) const {
  const Rows u = (coefficients[0] * m_t + coefficients[1]) * m_t + coefficients[2];
  const Rows inverse = (1 + u * u).sqrt().inverse();
  const Rows reflectance = 0.5 + 0.5 * u * inverse;
  const Rows slope = 0.5 * inverse * inverse * inverse;
  const Eigen::Vector3d xyz = m_weights.rightCols<3>().transpose() * reflectance.matrix();
  const Eigen::Matrix<double, 9, 1> products = m_weights.transpose() * slope.matrix();
  Eigen::Vector3d slopes;
  State state;
  state.residual = labOf(xyz, &slopes) - targetLab;
  const Eigen::Matrix3d f = slopes.asDiagonal() * Eigen::Map<const Eigen::Matrix3d>(products.data());
  state.derivative.row(0) = 116 * f.row(1);
  state.derivative.row(1) = 500 * (f.row(0) - f.row(1));
  state.derivative.row(2) = 200 * (f.row(1) - f.row(2));
  return state;
}

JakobSolver::Solution JakobSolver::descend(Eigen::Vector3d coefficients, const Eigen::Vector3d& targetLab) const {
  State state = stateAt(coefficients, targetLab);
  double error = state.residual.squaredNorm();
  double damping = 1e-3;
  for (int step = 0; step < kMostSteps && error > kMet * kMet && damping < 1e12; ++step) {
    Eigen::Matrix3d normal = state.derivative.transpose() * state.derivative;
    normal.diagonal() *= 1 + damping;
    normal.diagonal().array() += 1e-300;
    const Eigen::Vector3d move = normal.llt().solve(state.derivative.transpose() * state.residual);
    const Eigen::Vector3d tried = coefficients - move;
    const State next = stateAt(tried, targetLab);
    const double nextError = next.residual.squaredNorm();
    if (nextError < error) {
      const bool isAtRest = nextError > 0.999999 * error && damping < 1e-2;
      coefficients = tried;
      state = next;
      error = nextError;
      damping = std::max(damping * 0.05, 1e-12);
      if (isAtRest) {
        break;
      }
    } else {
      // NaN comes here too: a step too far.
      damping *= 10;
    }
  }
  return {coefficients, std::sqrt(error)};
}

JakobSolver::Solution JakobSolver::fromOtherPlaces(Solution best, const Eigen::Vector3d& xyz,
                                                   const Eigen::Vector3d& targetLab) const {
  const auto keep = [&](const Solution& found) {
    if (found.error < best.error) {
      best = found;
    }
  };
  // From a middle grey to the colour in a few steps, each from the last.
  constexpr int kParts = 6;
  Eigen::Vector3d coefficients = Eigen::Vector3d::Zero();
  for (int i = 1; i <= kParts; ++i) {
    const Eigen::Vector3d between = m_white / 2 + (xyz - m_white / 2) * (i / static_cast<double>(kParts));
    const Solution found = descend(coefficients, labOf(between, nullptr));
    coefficients = found.coefficients;
    if (i == kParts) {
      keep(found);
    }
  }
  // A hill, a valley and two slopes.
  for (const Eigen::Vector3d& start : {Eigen::Vector3d(-40, 40, -8), Eigen::Vector3d(40, -40, 8),
                                       Eigen::Vector3d(0, 8, -4), Eigen::Vector3d(0, -8, 4)}) {
    if (best.error > kLeft) {
      keep(descend(start, targetLab));
    }
  }
  return best;
}

JakobSolver::Solution JakobSolver::solve(const Eigen::Vector3d& xyz) const {
  return solveFrom({0, 0, flat(xyz[1] / m_white[1])}, xyz);
}

JakobSolver::Solution JakobSolver::solveFrom(const Eigen::Vector3d& start, const Eigen::Vector3d& xyz) const {
  const Eigen::Vector3d targetLab = labOf(xyz, nullptr);
  const Solution found = descend(start, targetLab);
  return found.error <= kLeft ? found : fromOtherPlaces(found, xyz, targetLab);
}

}  // namespace metamer::spectral
