// SPDX-License-Identifier: Apache-2.0
#include "soft_bound/soft_bound_solver.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace metamer::sip {

namespace {

using Eigen::Array4d;
using Eigen::Index;

/// Newton's method settles in a few rounds, at most about ten; a cap for what cannot be foreseen.
constexpr int kMostRounds = 60;
/// A band of no more than this part of the spectrum is zero but for rounding, and as good clamped as free: it may
/// change sides for ever.
constexpr double kNothing = 1e-12;
/// A guess that takes longer is a bad one: far too many bands are let go one a round.
constexpr int kMostGuessedRounds = 10;
constexpr int kMostHalvings = 30;

std::size_t at(int band) {
  return static_cast<std::size_t>(band);
}

ClampedBands belowZero(const BandVector& spectrum) {
  ClampedBands clamped;
  for (Index b = 0; b < spectrum.size(); ++b) {
    clamped[static_cast<std::size_t>(b)] = spectrum[b] < 0.0;
  }
  return clamped;
}

/// Whether the bands that were clamped for a spectrum are those that it has below zero.
bool holdsFor(const ClampedBands& clamped, const BandVector& spectrum) {
  const double nothing = kNothing * spectrum.cwiseAbs().maxCoeff();
  for (Index b = 0; b < spectrum.size(); ++b) {
    if ((spectrum[b] < 0.0) != clamped[static_cast<std::size_t>(b)] && !(std::abs(spectrum[b]) <= nothing)) {
      return false;
    }
  }
  return true;
}

/// Minus the second difference with natural ends.
double bend(const double* values, int band, int bandCount) {
  const double left = band > 0 ? values[band] - values[band - 1] : 0.0;
  const double right = band + 1 < bandCount ? values[band] - values[band + 1] : 0.0;
  return left + right;
}

/// A spectrum without clamped bands from the tristimulus: the twice-summed weights, a constant, and four equations.
BandTriple smoothest(const Eigen::Matrix3Xd& weights, double slack) {
  const Index bandCount = weights.cols();
  // R = height - drop * multipliers, with multipliers that sum to zero as every row of weights sums to one.
  Eigen::MatrixX3d drop(bandCount, 3);
  drop.row(0).setZero();
  Eigen::RowVector3d slope = Eigen::RowVector3d::Zero();
  for (Index b = 1; b < bandCount; ++b) {
    slope += weights.col(b - 1).transpose();
    drop.row(b) = drop.row(b - 1) + slope;
  }
  Eigen::Matrix4d system = Eigen::Matrix4d::Zero();
  system.topLeftCorner<3, 3>() = slack * Eigen::Matrix3d::Identity() - weights * drop;
  system.topRightCorner<3, 1>() = weights.rowwise().sum();
  system.bottomLeftCorner<1, 3>().setOnes();
  Eigen::Matrix<double, 4, 3> target = Eigen::Matrix<double, 4, 3>::Zero();
  target.topRows<3>().setIdentity();
  const Eigen::FullPivLU<Eigen::Matrix4d> factored(system);
  Eigen::Matrix<double, 4, 3> unknowns = factored.solve(target);
  unknowns += factored.solve(target - system * unknowns);
  // A white of (1, 1, 1) takes no multipliers at all.
  unknowns.topRows<3>().colwise() -= unknowns.topRows<3>().rowwise().sum() / 3.0;
  BandTriple spectrum = -drop * unknowns.topRows<3>();
  spectrum.rowwise() += unknowns.row(3);
  if (slack == 0.0) {
    // What the constraints miss by rounding changes the roughness to first order, all else to second.
    spectrum += (spectrum * (Eigen::Matrix3d::Identity() - weights * spectrum)).eval();
  }
  return spectrum;
}

}  // namespace

/// The tridiagonal system with some bands clamped, at least one, solved for several loads at once.
struct SoftBoundSolver::Elimination {
  Elimination(const SoftBoundSolver& solver, const ClampedBands& clamped) : bandCount(solver.bandCount()) {
    while (!clamped[at(first)]) {
      ++first;
    }
    last = bandCount - 1;
    while (!clamped[at(last)]) {
      --last;
    }
    const double price = solver.m_boundPrice;
    if (first == last) {
      inversePivot[at(first)] = 1.0 / price;
      return;
    }
    inversePivot[at(first)] = 1.0 / (1.0 + price);
    for (int b = first + 1; b <= last; ++b) {
      const double diagonal = (b < last ? 2.0 : 1.0) + (clamped[at(b)] ? price : 0.0);
      inversePivot[at(b)] = 1.0 / (diagonal - inversePivot[at(b - 1)]);
    }
  }

  /// @param load(b)    of band b, first < b < last
  /// @param upTo(b)    sum of the loads of bands 0 ... b, b <= first
  /// @param behind(b)  sum of the loads of bands b ... B - 1, b >= last
  /// @param all        sum of all loads
  template <typename Load, typename UpTo, typename Behind>
  void solve(const Load& load, const UpTo& upTo, const Behind& behind, const Array4d& all,
             std::array<Array4d, kConvergedBandCount>& result) const {
    if (first == last) {
      result[at(first)] = all * inversePivot[at(first)];
    } else {
      Array4d carried = upTo(first);
      result[at(first)] = carried;
      for (int b = first + 1; b < last; ++b) {
        carried = load(b) + carried * inversePivot[at(b - 1)];
        result[at(b)] = carried;
      }
      Array4d value = (behind(last) + carried * inversePivot[at(last - 1)]) * inversePivot[at(last)];
      result[at(last)] = value;
      for (int b = last - 1; b >= first; --b) {
        value = (result[at(b)] + value) * inversePivot[at(b)];
        result[at(b)] = value;
      }
    }
    Array4d value = result[at(first)];
    for (int b = first - 1; b >= 0; --b) {
      value += upTo(b);
      result[at(b)] = value;
    }
    value = result[at(last)];
    for (int b = last + 1; b < bandCount; ++b) {
      value += behind(b);
      result[at(b)] = value;
    }
  }

  int bandCount;
  int first = 0;
  int last = 0;
  std::array<double, kConvergedBandCount> inversePivot;
};

SoftBoundSolver::SoftBoundSolver(const Eigen::Matrix3Xd& weights, double relaxation)
    : m_weights(weights), m_slack(relaxation > 0.0 ? 1.0 / relaxation : 0.0), m_relaxation(relaxation) {
  const double bandNm = bandCentreNm(1, bandCount()) - bandCentreNm(0, bandCount());
  m_boundPrice = kBoundPricePerSquareNm * bandNm * bandNm;
  const auto count = static_cast<std::size_t>(bandCount());
  m_load.resize(count);
  m_loadUpTo.resize(count);
  m_loadBehind.resize(count);
  Array4d sum = Array4d::Zero();
  for (std::size_t b = 0; b < count; ++b) {
    m_load[b] << weights.col(static_cast<Index>(b)).array(), 0.0;
    sum += m_load[b];
    m_loadUpTo[b] = sum;
  }
  sum.setZero();
  for (std::size_t b = count; b-- > 0;) {
    sum += m_load[b];
    m_loadBehind[b] = sum;
  }
  m_unclamped = smoothest(m_weights, m_slack);
}

double SoftBoundSolver::objective(const BandVector& spectrum, const BandVector* prior,
                                  const Eigen::Vector3d& target) const {
  const Index count = spectrum.size();
  const BandVector deviation = prior != nullptr ? BandVector(spectrum - *prior) : spectrum;
  double sum = (deviation.tail(count - 1) - deviation.head(count - 1)).squaredNorm() +
               m_boundPrice * spectrum.cwiseMin(0.0).squaredNorm();
  if (m_relaxation > 0.0) {
    sum += m_relaxation * (target - m_weights * spectrum).squaredNorm();
  }
  return sum;
}

SoftBoundSolver::Solution SoftBoundSolver::solve(const Eigen::Vector3d& tristimulus, const BandVector* prior,
                                                 const ClampedBands* start) const {
  const int count = bandCount();
  Solution solution;
  ClampedBands guess;
  if (start != nullptr && start->any()) {
    guess = *start;
  } else {
    solution.reflectance = m_unclamped * tristimulus;
    if (prior != nullptr) {
      solution.reflectance += *prior;
    }
    if (holdsFor(guess, solution.reflectance)) {
      return solution;
    }
    guess = belowZero(solution.reflectance);
  }
  const double* p = prior != nullptr ? prior->data() : nullptr;
  // What the spectrum's own response is held to.
  Eigen::Vector3d held = tristimulus;
  if (prior != nullptr && m_slack > 0.0) {
    held += m_weights * *prior;
  }
  const auto bendOfPrior = [&](int b) { return p != nullptr ? bend(p, b, count) : 0.0; };
  // The loads of the prior's bend sum to its slopes, and all of them to nothing.
  const auto load = [&](int b) {
    Array4d lanes = m_load[at(b)];
    lanes[3] = bendOfPrior(b);
    return lanes;
  };
  const auto upTo = [&](int b) {
    Array4d lanes = m_loadUpTo[at(b)];
    lanes[3] = p != nullptr && b + 1 < count ? p[b] - p[b + 1] : 0.0;
    return lanes;
  };
  const auto behind = [&](int b) {
    Array4d lanes = m_loadBehind[at(b)];
    lanes[3] = p != nullptr && b > 0 ? p[b] - p[b - 1] : 0.0;
    return lanes;
  };
  bool hasPoint = solution.reflectance.size() > 0;
  double reached = hasPoint ? objective(solution.reflectance, prior, held) : 0.0;
  std::array<Array4d, kConvergedBandCount> answers;
  while (true) {
    ++solution.rounds;
    BandVector next(count);
    if (guess.none()) {
      next = m_unclamped * tristimulus;
      if (prior != nullptr) {
        next += *prior;
      }
    } else {
      const Elimination elimination(*this, guess);
      elimination.solve(load, upTo, behind, m_loadUpTo[at(count - 1)], answers);
      std::array<Array4d, 3> sums = {Array4d::Zero(), Array4d::Zero(), Array4d::Zero()};
      for (int b = 0; b < count; ++b) {
        const Array4d& weight = m_load[at(b)];
        for (std::size_t k = 0; k < 3; ++k) {
          sums[k] += weight[static_cast<Index>(k)] * answers[at(b)];
        }
      }
      Eigen::Matrix3d system;
      Eigen::Vector3d target = held;
      for (std::size_t k = 0; k < 3; ++k) {
        const auto row = static_cast<Index>(k);
        system.row(row) = sums[k].head<3>().matrix().transpose();
        target[row] -= sums[k][3];
      }
      system.diagonal().array() += m_slack;
      // Once more for what is left: lights that hardly tell two channels apart lose half the digits.
      const Eigen::Matrix3d inverse = system.inverse();
      Eigen::Vector3d multipliers = inverse * target;
      multipliers += inverse * (target - system * multipliers);
      Array4d pull;
      pull << multipliers.array(), 1.0;
      for (int b = 0; b < count; ++b) {
        next[b] = (answers[at(b)] * pull).sum();
      }
    }
    if (holdsFor(guess, next) || solution.rounds == kMostRounds) {
      solution.reflectance = next;
      break;
    }
    if (start != nullptr && solution.rounds == kMostGuessedRounds) {
      solution = solve(tristimulus, prior);
      solution.rounds += kMostGuessedRounds;
      return solution;
    }
    double step = 1.0;
    if (hasPoint) {
      const BandVector from = solution.reflectance;
      const BandVector whole = next;
      double value = objective(next, prior, held);
      for (int halving = 0; value > reached && halving < kMostHalvings; ++halving) {
        step *= 0.5;
        next = from + step * (whole - from);
        value = objective(next, prior, held);
      }
      reached = value;
    } else {
      reached = objective(next, prior, held);
      hasPoint = true;
    }
    solution.reflectance = next;
    guess = belowZero(next);
  }
  solution.clamped = guess;
  return solution;
}

BandTriple SoftBoundSolver::derivative(const ClampedBands& clamped, const BandTriple* priorSlope) const {
  if (clamped.none()) {
    return priorSlope != nullptr ? BandTriple(m_unclamped + *priorSlope) : m_unclamped;
  }
  const int count = bandCount();
  const Elimination elimination(*this, clamped);
  std::array<Array4d, kConvergedBandCount> answers;
  elimination.solve([&](int b) { return m_load[at(b)]; }, [&](int b) { return m_loadUpTo[at(b)]; },
                    [&](int b) { return m_loadBehind[at(b)]; }, m_loadUpTo[at(count - 1)], answers);
  BandTriple pulled(count, 3);
  for (int b = 0; b < count; ++b) {
    pulled.row(b) = answers[at(b)].head<3>().matrix().transpose();
  }
  const Eigen::Matrix3d inverse = (m_weights * pulled + m_slack * Eigen::Matrix3d::Identity()).inverse();
  if (priorSlope == nullptr) {
    return pulled * inverse;
  }
  const auto lanes = [](const Eigen::RowVector3d& row) {
    Array4d all = Array4d::Zero();
    all.head<3>() = row.transpose().array();
    return all;
  };
  const BandTriple& p = *priorSlope;
  elimination.solve([&](int b) { return lanes((p.row(b) - p.row(b - 1)) + (p.row(b) - p.row(b + 1))); },
                    [&](int b) { return b + 1 < count ? lanes(p.row(b) - p.row(b + 1)) : Array4d(Array4d::Zero()); },
                    [&](int b) { return b > 0 ? lanes(p.row(b) - p.row(b - 1)) : Array4d(Array4d::Zero()); },
                    Array4d::Zero(), answers);
  BandTriple own(count, 3);
  for (int b = 0; b < count; ++b) {
    own.row(b) = answers[at(b)].head<3>().matrix().transpose();
  }
  Eigen::Matrix3d target = Eigen::Matrix3d::Identity() - m_weights * own;
  if (m_slack > 0.0) {
    target += m_weights * p;
  }
  return own + pulled * (inverse * target);
}

}  // namespace metamer::sip
