// SPDX-License-Identifier: Apache-2.0
#include "soft_bound/soft_bound_solver.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>

#include "soft_bound/newton_lanes.h"
#include "soft_bound/smooth_start.h"

namespace metamer::sip {

namespace {

using Eigen::Array4d;
using Array8d = Eigen::Array<double, 8, 1>;
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

/// Band by band, the first `count` rows as lanes. The count is known beforehand so that the loop is unrolled.
template <std::size_t count>
void putSideBySide(const std::array<const double*, NewtonLanes::kLanes>& rows, int bandCount, double* lanes) {
  for (int b = 0; b < bandCount; ++b, lanes += NewtonLanes::kLanes) {
    for (std::size_t lane = 0; lane < count; ++lane) {
      lanes[lane] = rows[lane][b];
    }
  }
}

/// Three lanes of what an elimination gives, a row a band.
template <typename Lanes>
BandTriple columns(const std::array<Lanes, kConvergedBandCount>& answers, int bandCount, Index first) {
  BandTriple triple(bandCount, 3);
  for (int b = 0; b < bandCount; ++b) {
    triple.row(b) = answers[at(b)].template segment<3>(first).matrix().transpose();
  }
  return triple;
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
  /// @tparam Lanes     an array of so many loads
  template <typename Lanes, typename Load, typename UpTo, typename Behind>
  void solve(const Load& load, const UpTo& upTo, const Behind& behind, const Lanes& all,
             std::array<Lanes, kConvergedBandCount>& result) const {
    if (first == last) {
      result[at(first)] = all * inversePivot[at(first)];
    } else {
      Lanes carried = upTo(first);
      result[at(first)] = carried;
      for (int b = first + 1; b < last; ++b) {
        carried = load(b) + carried * inversePivot[at(b - 1)];
        result[at(b)] = carried;
      }
      Lanes value = (behind(last) + carried * inversePivot[at(last - 1)]) * inversePivot[at(last)];
      result[at(last)] = value;
      for (int b = last - 1; b >= first; --b) {
        value = (result[at(b)] + value) * inversePivot[at(b)];
        result[at(b)] = value;
      }
    }
    Lanes value = result[at(first)];
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
  problem.clamped.reset();
  return SmoothStart{m_unclamped.data(), bandCount()}(problem.tristimulus.data(), problem.prior, problem.reflectance);
}

void SoftBoundSolver::fill(NewtonLanes& lanes, std::span<Problem* const> group) const {
  lanes.hasPrior = group.front()->prior != nullptr;
  constexpr std::size_t kLanes = NewtonLanes::kLanes;
  // Idle lanes repeat the last problem: what is computed there is not looked at.
  std::array<const Problem*, kLanes> problems;
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    problems[lane] = group[std::min(lane, group.size() - 1)];
    lanes.isUsed[lane] = lane < group.size() ? 1.0 : 0.0;
    const Problem& problem = *problems[lane];
    Eigen::Vector3d held = problem.tristimulus;
    if (problem.prior != nullptr && m_slack > 0.0) {
      held += m_weights * Eigen::Map<const Eigen::VectorXd>(problem.prior, bandCount());
    }
    for (std::size_t k = 0; k < 3; ++k) {
      lanes.tristimulus[k * kLanes + lane] = problem.tristimulus[static_cast<Index>(k)];
      lanes.held[k * kLanes + lane] = held[static_cast<Index>(k)];
    }
  }
  const bool areFew = group.size() <= NewtonLanes::kFew;
  const auto sideBySide = [&](auto rowOf, auto& rows) {
    std::array<const double*, kLanes> from;
    std::transform(problems.begin(), problems.end(), from.begin(), rowOf);
    if (areFew) {
      putSideBySide<NewtonLanes::kFew>(from, bandCount(), rows.data());
    } else {
      putSideBySide<kLanes>(from, bandCount(), rows.data());
    }
  };
  sideBySide([](const Problem* problem) { return problem->reflectance; }, lanes.spectrum);
  if (lanes.hasPrior) {
    sideBySide([](const Problem* problem) { return problem->prior; }, lanes.prior);
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
    const double* spectrum = lanes.spectrum.data() + lane;
    const double* clamp = lanes.clamp.data() + lane;
    constexpr int kWord = 64;  // bits that are gathered before they are put among the others
    for (int first = 0; first < bandCount(); first += kWord) {
      std::uint64_t word = 0;
      const int count = std::min(kWord, bandCount() - first);
      for (int b = 0; b < count; ++b, spectrum += NewtonLanes::kLanes, clamp += NewtonLanes::kLanes) {
        problem.reflectance[first + b] = *spectrum;
        word |= static_cast<std::uint64_t>(*clamp > 0.0) << b;
      }
      problem.clamped |= ClampedBands(word) << at(first);
    }
  }
}

Eigen::Matrix3d seen(const Eigen::Matrix3Xd& weights, const Eigen::Ref<const Eigen::MatrixX3d>& spectra) {
  Eigen::Array3d first = Eigen::Array3d::Zero();
  Eigen::Array3d second = first;
  Eigen::Array3d third = first;
  for (Index b = 0; b < weights.cols(); ++b) {
    const Eigen::Array3d weight = weights.col(b);
    first += weight * spectra(b, 0);
    second += weight * spectra(b, 1);
    third += weight * spectra(b, 2);
  }
  Eigen::Matrix3d sums;
  sums << first, second, third;
  return sums;
}

BandTriple SoftBoundSolver::derivative(const ClampedBands& clamped, const BandTriple* priorSlope) const {
  if (clamped.none()) {
    return priorSlope != nullptr ? BandTriple(m_unclamped + *priorSlope) : m_unclamped;
  }
  const int count = bandCount();
  const Elimination elimination(*this, clamped);
  if (priorSlope == nullptr) {
    std::array<Array4d, kConvergedBandCount> answers;
    elimination.solve([&](int b) { return m_load[at(b)]; }, [&](int b) { return m_loadUpTo[at(b)]; },
                      [&](int b) { return m_loadBehind[at(b)]; }, m_loadUpTo[at(count - 1)], answers);
    const BandTriple pulled = columns(answers, count, 0);
    const Eigen::Matrix3d inverse = (seen(m_weights, pulled) + m_slack * Eigen::Matrix3d::Identity()).inverse();
    return pulled.lazyProduct(inverse);
  }
  // Both at once, as each waits long for its own last band.
  const BandTriple& p = *priorSlope;
  const auto bend = [&](int b, int other) -> Eigen::RowVector3d {
    return other >= 0 && other < count ? p.row(b) - p.row(other) : Eigen::RowVector3d::Zero().eval();
  };
  const auto lanes = [](const Array4d& load, const Eigen::RowVector3d& bent) {
    Array8d all;
    all << load, bent.transpose().array(), 0.0;
    return all;
  };
  std::array<Array8d, kConvergedBandCount> answers;
  elimination.solve([&](int b) { return lanes(m_load[at(b)], (p.row(b) - p.row(b - 1)) + (p.row(b) - p.row(b + 1))); },
                    [&](int b) { return lanes(m_loadUpTo[at(b)], bend(b, b + 1)); },
                    [&](int b) { return lanes(m_loadBehind[at(b)], bend(b, b - 1)); },
                    lanes(m_loadUpTo[at(count - 1)], Eigen::RowVector3d::Zero()), answers);
  const BandTriple pulled = columns(answers, count, 0);
  const BandTriple own = columns(answers, count, 4);
  const Eigen::Matrix3d inverse = (seen(m_weights, pulled) + m_slack * Eigen::Matrix3d::Identity()).inverse();
  Eigen::Matrix3d target = Eigen::Matrix3d::Identity() - seen(m_weights, own);
  if (m_slack > 0.0) {
    target += seen(m_weights, p);
  }
  return own + pulled.lazyProduct(inverse * target);
}

}  // namespace metamer::sip
