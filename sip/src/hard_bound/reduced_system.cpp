// SPDX-License-Identifier: Apache-2.0
#include "hard_bound/reduced_system.h"

#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>

namespace metamer::sip {

namespace {

/// Relative size below which a pivot of the scaled system counts as zero.
constexpr double kZeroPivot = 1e-13;
/// Determinant of the three scaled equations below which they are solved as if they depended on each other.
constexpr double kZeroDeterminant = 1e-13;

/// Scale that gives each channel unit weight; a channel without weights is no constraint and keeps zero.
Eigen::Vector3d unitScale(const Eigen::Vector3d& diagonal) {
  return diagonal.unaryExpr([](double value) { return value > 0.0 ? 1.0 / std::sqrt(value) : 0.0; });
}

/// Pseudo-inverse; clears `fullRank` where it is not an inverse.
template <int n>
Eigen::Matrix<double, n, n> pseudoInverse(const Eigen::Matrix<double, n, n>& matrix, bool& fullRank) {
  Eigen::CompleteOrthogonalDecomposition<Eigen::Matrix<double, n, n>> decomposition;
  decomposition.setThreshold(kZeroPivot);
  decomposition.compute(matrix);
  fullRank = fullRank && decomposition.rank() == n;
  return decomposition.pseudoInverse();
}

}  // namespace

ReducedSystem::ReducedSystem(const BandTable& table, const BandStates& states, const Guide* guide, Held held)
    : m_table(table), m_states(states), m_guide(guide), m_held(held) {
  const int count = table.bandCount();
  const auto stateAt = [&states](int b) { return states[static_cast<std::size_t>(b)]; };
  bool anyAtOne = false;
  for (int b = 0; held == Held::AtBounds && b < count; b = endOfStretch(states, b, count)) {
    anyAtOne = anyAtOne || stateAt(b) == BandState::AtOne;
  }
  if (guide != nullptr || anyAtOne) {
    m_fixed.resize(count);
    for (int b = 0; b < count; ++b) {
      m_fixed[b] = heldValue(b);
    }
  }
  Eigen::Matrix3d schur = Eigen::Matrix3d::Zero();
  for (int first = 0, end = 0; first < count; first = end) {
    end = endOfStretch(states, first, count);
    if (stateAt(first) == BandState::Free) {
      addRun(first, end, schur);
    }
  }
  invert(schur);
}

double ReducedSystem::guideForce(int band) const {
  if (m_guide == nullptr) {
    return 0.0;
  }
  const Eigen::VectorXd& f = m_guide->values;
  const double left = band > 0 ? f[band] - f[band - 1] : 0.0;
  const double right = band + 1 < m_table.bandCount() ? f[band] - f[band + 1] : -m_guide->endSlope;
  return left + right;
}

void ReducedSystem::addRun(int first, int end, Eigen::Matrix3d& schur) {
  Run& run = m_runs[static_cast<std::size_t>(m_runCount++)];
  run.first = first;
  run.end = end;
  run.base.setZero();
  run.slope.setZero();
  const bool naturalStart = first == 0;
  const bool naturalEnd = end == m_table.bandCount();
  m_nothingHeld = naturalStart && naturalEnd;
  const RunSums sums = m_table.sumsOver(first, end);
  if (!m_nothingHeld) {
    if (naturalStart) {
      run.base = sums.curve;
    } else if (naturalEnd) {
      run.slope = sums.weight;
    } else {
      run.slope = sums.curve / static_cast<double>(end - first + 1);
    }
  }
  for (std::size_t k = 0; k < 3; ++k) {
    const auto row = static_cast<Eigen::Index>(k);
    const Eigen::Array4d line = sums.weight[row] * run.base + sums.moment[row] * run.slope;
    schur.row(row) += (line - sums.product[k]).head<3>().matrix().transpose();
  }
  if (m_fixed.size() > 0) {
    fix(run);
  }
}

void ReducedSystem::fix(const Run& run) {
  const auto guideAt = [this](int b) { return m_guide != nullptr ? m_guide->values[b] : 0.0; };
  // The line takes F off at the run's ends and puts what the neighbours hold in its place.
  double height = 0.0;
  double slope = 0.0;
  if (!m_nothingHeld) {
    if (run.first == 0) {
      height = heldValue(run.end) - guideAt(run.end);
    } else {
      height = heldValue(run.first - 1) - guideAt(run.first - 1);
      if (run.end < m_table.bandCount()) {
        slope = (heldValue(run.end) - guideAt(run.end) - height) / static_cast<double>(run.end - run.first + 1);
      } else {
        slope = m_guide != nullptr ? -m_guide->endSlope : 0.0;
      }
    }
  }
  for (int b = run.first; b < run.end; ++b) {
    m_fixed[b] = guideAt(b) + height + slope * static_cast<double>(b - run.first + 1);
  }
}

void ReducedSystem::invert(const Eigen::Matrix3d& schur) {
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();  // what the fixed part already gives
  if (m_fixed.size() > 0) {
    offset = m_table.sumOf(m_fixed);
  }
  m_inverse.setZero();
  if (!m_nothingHeld) {
    const Eigen::Vector3d scale = unitScale(schur.diagonal());
    Eigen::Matrix3d scaled = scale.asDiagonal() * schur * scale.asDiagonal();
    for (int k = 0; k < 3; ++k) {
      if (scale[k] == 0.0) {
        scaled(k, k) = 1.0;
      }
    }
    Eigen::Matrix3d inverse;
    double determinant = 0.0;
    bool invertible = false;
    scaled.computeInverseAndDetWithCheck(inverse, determinant, invertible, kZeroDeterminant);
    if (!invertible) {
      inverse = pseudoInverse<3>(scaled, m_fullRank);
    }
    m_inverse.topRows<3>() = scale.asDiagonal() * inverse * scale.asDiagonal();
    m_start = -m_inverse * offset;
    return;
  }
  // R = fixed - multipliers . Q + height, and a natural end: multipliers . (sum of A) = the guide's slope there.
  Eigen::Vector3d total = Eigen::Vector3d::Zero();
  for (int b = 0; b < m_table.bandCount(); ++b) {
    total += m_table.weight(b).matrix().head<3>();
  }
  const Eigen::Vector3d scale = unitScale(schur.diagonal().cwiseAbs());
  Eigen::Matrix4d scaled = Eigen::Matrix4d::Zero();
  scaled.topLeftCorner<3, 3>() = scale.asDiagonal() * schur * scale.asDiagonal();
  scaled.topRightCorner<3, 1>() = scale.asDiagonal() * total;
  scaled.bottomLeftCorner<1, 3>() = total.transpose() * scale.asDiagonal();
  for (int k = 0; k < 3; ++k) {
    if (scale[k] == 0.0) {
      scaled(k, k) = 1.0;
    }
  }
  Eigen::Vector4d allScales;
  allScales << scale, 1.0;
  const Eigen::Matrix4d inverse =
      allScales.asDiagonal() * pseudoInverse<4>(scaled, m_fullRank) * allScales.asDiagonal();
  m_inverse = inverse.leftCols<3>();
  Eigen::Vector4d right;
  right << -offset, m_guide != nullptr ? m_guide->endSlope : 0.0;
  m_start = inverse * right;
}

void ReducedSystem::evaluate(Trial& trial) const {
  const Eigen::Vector4d& unknowns = trial.unknowns;
  const auto along = [&unknowns](const Eigen::Array4d& lanes) {
    return lanes[0] * unknowns[0] + lanes[1] * unknowns[1] + lanes[2] * unknowns[2];
  };
  const Eigen::ArrayX3d& channels = m_table.channels();
  trial.pull = channels.col(0) * unknowns[0] + channels.col(1) * unknowns[1] + channels.col(2) * unknowns[2];
  if (m_fixed.size() > 0) {
    trial.spectrum = m_fixed;
  } else {
    trial.spectrum.setZero(m_table.bandCount());
  }
  for (int i = 0; i < m_runCount; ++i) {
    const Run& run = m_runs[static_cast<std::size_t>(i)];
    const double slope = along(run.slope);
    double line = along(run.base) + unknowns[3];
    double curveSlope = 0.0;
    double curve = 0.0;
    for (int b = run.first; b < run.end; ++b) {
      line += slope;
      trial.spectrum[b] += line - curve;
      curveSlope += trial.pull[b];
      curve += curveSlope;
    }
  }
}

void ReducedSystem::solve(const Eigen::Vector3d& target, Trial& trial) const {
  trial.unknowns = m_start + m_inverse * target;
  evaluate(trial);
}

void ReducedSystem::refine(const Eigen::Vector3d& target, Trial& trial) const {
  trial.unknowns += m_inverse * (target - m_table.sumOf(trial.spectrum));
  evaluate(trial);
}

template <typename Visit>
void ReducedSystem::visitFree(const Visit& visit) const {
  for (int i = 0; i < m_runCount; ++i) {
    const Run& run = m_runs[static_cast<std::size_t>(i)];
    Eigen::Array4d line = run.base;
    Eigen::Array4d curveSlope = Eigen::Array4d::Zero();
    Eigen::Array4d curve = Eigen::Array4d::Zero();
    for (int b = run.first; b < run.end; ++b) {
      line += run.slope;
      visit(b, Eigen::Array4d(line - curve));
      curveSlope += m_table.weight(b);
      curve += curveSlope;
    }
  }
}

Eigen::Matrix3d ReducedSystem::response(const Eigen::MatrixX3d& functionals) const {
  std::array<Eigen::Array4d, 3> sums = {Eigen::Array4d::Zero(), Eigen::Array4d::Zero(), Eigen::Array4d::Zero()};
  visitFree([&](int b, const Eigen::Array4d& unit) {
    sums[0] += functionals(b, 0) * unit;
    sums[1] += functionals(b, 1) * unit;
    sums[2] += functionals(b, 2) * unit;
  });
  Eigen::Matrix3d perMultiplier;
  for (int row = 0; row < 3; ++row) {
    perMultiplier.row(row) = sums[static_cast<std::size_t>(row)].head<3>().matrix().transpose();
  }
  Eigen::Matrix3d matrix = perMultiplier * m_inverse.topRows<3>();
  if (m_nothingHeld) {
    matrix += functionals.colwise().sum().transpose() * m_inverse.row(3);
  }
  return matrix;
}

Eigen::MatrixX3d ReducedSystem::response() const {
  Eigen::MatrixX3d matrix = Eigen::MatrixX3d::Zero(m_table.bandCount(), 3);
  const Eigen::Matrix3d multipliers = m_inverse.topRows<3>();
  visitFree([&](int b, const Eigen::Array4d& unit) {
    const Eigen::RowVector3d pull = unit.head<3>().matrix().transpose();
    matrix.row(b).noalias() = pull * multipliers;
  });
  if (m_nothingHeld) {
    matrix.rowwise() += m_inverse.row(3);
  }
  return matrix;
}

}  // namespace metamer::sip
