// SPDX-License-Identifier: Apache-2.0
#include "soft_bound/soft_bound_solver.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "soft_bound/newton_lanes.h"

namespace metamer::sip {

namespace {

using Eigen::Array4d;
using Eigen::Index;

std::size_t at(int band) {
  return static_cast<std::size_t>(band);
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
  m_weightRows = m_weights.transpose();
  m_smoothRows = m_unclamped;
}

SoftBoundSolver::Solution SoftBoundSolver::solve(const Eigen::Vector3d& tristimulus, const BandVector* prior) const {
  Solution solution;
  solution.reflectance.resize(bandCount());
  Problem problem;
  problem.tristimulus = tristimulus;
  problem.prior = prior != nullptr ? prior->data() : nullptr;
  problem.reflectance = solution.reflectance.data();
  solve(std::span(&problem, 1));
  solution.clamped = problem.clamped;
  solution.rounds = problem.rounds;
  return solution;
}

void SoftBoundSolver::solve(std::span<Problem> problems) const {
  std::array<std::vector<Problem*>, 2> open;  // without and with a prior
  for (Problem& problem : problems) {
    problem.rounds = 0;
    if (!isSmoothEnough(problem)) {
      open[problem.prior != nullptr ? 1 : 0].push_back(&problem);
    }
  }
  for (const std::span<Problem* const> alike : open) {
    for (std::size_t first = 0; first < alike.size(); first += NewtonLanes::kLanes) {
      solveTogether(alike.subspan(first, std::min(NewtonLanes::kLanes, alike.size() - first)));
    }
  }
}

bool SoftBoundSolver::isSmoothEnough(Problem& problem) const {
  Eigen::Map<Eigen::VectorXd> spectrum(problem.reflectance, bandCount());
  spectrum.noalias() = m_unclamped * problem.tristimulus;
  if (problem.prior != nullptr) {
    spectrum += Eigen::Map<const Eigen::VectorXd>(problem.prior, bandCount());
  }
  problem.clamped.reset();
  if (spectrum.minCoeff() >= -kNothing * spectrum.cwiseAbs().maxCoeff()) {
    return true;
  }
  for (int b = 0; b < bandCount(); ++b) {
    problem.clamped[at(b)] = spectrum[b] < 0.0;
  }
  return false;
}

void SoftBoundSolver::fill(NewtonLanes& lanes, std::span<Problem* const> group) const {
  lanes.hasPrior = group.front()->prior != nullptr;
  const std::size_t laneCount = group.size() <= NewtonLanes::kFew ? NewtonLanes::kFew : NewtonLanes::kLanes;
  for (std::size_t lane = 0; lane < laneCount; ++lane) {
    lanes.isUsed[lane] = lane < group.size() ? 1.0 : 0.0;
    // Idle lanes repeat the last problem: what is computed there is not looked at.
    const Problem& problem = *group[std::min(lane, group.size() - 1)];
    Eigen::Vector3d held = problem.tristimulus;
    if (problem.prior != nullptr && m_slack > 0.0) {
      held += m_weights * Eigen::Map<const Eigen::VectorXd>(problem.prior, bandCount());
    }
    for (std::size_t k = 0; k < 3; ++k) {
      lanes.tristimulus[k * NewtonLanes::kLanes + lane] = problem.tristimulus[static_cast<Index>(k)];
      lanes.held[k * NewtonLanes::kLanes + lane] = held[static_cast<Index>(k)];
    }
    for (int b = 0; b < bandCount(); ++b) {
      const std::size_t place = at(b) * NewtonLanes::kLanes + lane;
      lanes.clamp[place] = problem.reflectance[b] < 0.0 ? m_boundPrice : 0.0;
      lanes.spectrum[place] = problem.reflectance[b];
      if (problem.prior != nullptr) {
        lanes.prior[place] = problem.prior[b];
      }
    }
  }
}

void SoftBoundSolver::solveTogether(std::span<Problem* const> group) const {
  NewtonLanes lanes;
  fill(lanes, group);
  solveByNewton({bandCount(), m_weightRows.data(), m_smoothRows.data(), m_boundPrice, m_slack, m_relaxation}, lanes,
                group.size());
  for (std::size_t lane = 0; lane < group.size(); ++lane) {
    Problem& problem = *group[lane];
    problem.rounds = static_cast<int>(lanes.rounds[lane]);
    for (int b = 0; b < bandCount(); ++b) {
      const std::size_t place = at(b) * NewtonLanes::kLanes + lane;
      problem.reflectance[b] = lanes.spectrum[place];
      problem.clamped[at(b)] = lanes.clamp[place] > 0.0;
    }
  }
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
