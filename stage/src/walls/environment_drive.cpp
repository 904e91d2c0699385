// SPDX-License-Identifier: Apache-2.0
#include "metamer/stage/environment_drive.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "metamer/spectral/argument_checks.h"
#include "metamer/spectral/input_error.h"

namespace metamer::stage {
namespace {

using spectral::InputError;
using Vector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMostEnvironmentEmitters, 1>;
using Square =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMostEnvironmentEmitters, kMostEnvironmentEmitters>;

/// A slope this small against the pixel is rounding.
constexpr double kSlopeTolerance = 1e-12;
/// Directions closer than this are one: keeps the interpolation's weights finite.
constexpr double kSameDirection = 1e-6;
/// Sets tried before the whole problem is solved again.
constexpr std::size_t kMostGuesses = 12;

}  // namespace

/// What is linear while one set of emitters is lit.
struct EnvironmentDriver::Piece {
  std::uint32_t support = 0;
  Square drives;  ///< n x n: drives from the reduced target; rows of dark emitters are 0
  Square slopes;  ///< n x n: gradients of the dark emitters; rows of lit ones are 0
};

struct EnvironmentDriver::Memory::State {
  std::unordered_map<std::uint32_t, std::unique_ptr<Piece>> pieces;
  std::vector<std::uint32_t> recent;  ///< the last sets that were right, latest first
};

EnvironmentDriver::Memory::Memory() : m_state(std::make_unique<State>()) {}
EnvironmentDriver::Memory::~Memory() = default;

void EnvironmentDriver::Memory::startRow() {
  m_state->recent.clear();
}

EnvironmentDriver::EnvironmentDriver(const std::vector<Eigen::Matrix3Xd>& emitterCharts,
                                     const std::vector<SceneChart>& sceneCharts, int whitePatch, DriveLimits limits)
    : m_limits(std::move(limits)) {
  const auto count = static_cast<Eigen::Index>(emitterCharts.size());
  if (count < 1 || count > kMostEnvironmentEmitters) {
    throw InputError("", "emitters", std::to_string(count), "must be 1 to " + std::to_string(kMostEnvironmentEmitters));
  }
  if (sceneCharts.empty()) {
    throw InputError("", "scene charts", "", "are none; give the chart as it looked in the real place");
  }
  const Eigen::Index patches = emitterCharts.front().cols();
  for (const Eigen::Matrix3Xd& chart : emitterCharts) {
    spectral::requireAsMany("patches of an emitter's chart", chart.cols(), "the first has", patches);
  }
  spectral::requireWithin("white patch", whitePatch, 0, static_cast<double>(patches) - 1);
  const Eigen::Index rows = emitterCharts.front().size();
  Eigen::MatrixXd matrix(rows, count);
  for (Eigen::Index k = 0; k < count; ++k) {
    matrix.col(k) = emitterCharts[static_cast<std::size_t>(k)].reshaped();
  }
  if (!(matrix.norm() > 0)) {
    throw InputError("", "emitters", "", "give no light at all; check their charts");
  }
  nonNegativeLeastSquares(matrix, Eigen::VectorXd::Ones(rows), m_limits);  // refuses bad limits
  const Eigen::HouseholderQR<Eigen::MatrixXd> factors(matrix);
  const Eigen::Index kept = std::min(rows, count);
  m_emitters = Eigen::MatrixXd::Zero(count, count);
  m_emitters.topRows(kept) = factors.matrixQR().topRows(kept).triangularView<Eigen::Upper>();
  for (const SceneChart& chart : sceneCharts) {
    spectral::requireAsMany("patches of a scene chart", chart.rgb.cols(), "the emitters' have", patches);
    const Eigen::Vector3d white = chart.rgb.col(whitePatch);
    if (!(white.minCoeff() > 0)) {
      throw InputError("", "white patch", "", "gives no light in a channel of a scene chart; name the white patch");
    }
    if (!(chart.facing.norm() > 0)) {
      throw InputError("", "direction", "0, 0, 0", "of a scene chart must not be nothing");
    }
    // Patch p's channel c is the pixel's channel c times this chart's p over white.
    Eigen::MatrixX3d target = Eigen::MatrixX3d::Zero(rows, 3);
    for (Eigen::Index p = 0; p < chart.rgb.cols(); ++p) {
      for (Eigen::Index c = 0; c < 3; ++c) {
        target(3 * p + c, c) = chart.rgb(c, p) / white[c];
      }
    }
    Eigen::MatrixX3d reduced = Eigen::MatrixX3d::Zero(count, 3);
    const Eigen::MatrixXd rotated = factors.householderQ().transpose() * target;
    reduced.topRows(kept) = rotated.topRows(kept);
    m_targets.push_back(reduced);
    m_facings.push_back(chart.facing.normalized());
  }
}

const EnvironmentDriver::Piece& EnvironmentDriver::pieceOf(std::uint32_t support, Memory& memory) const {
  std::unique_ptr<Piece>& piece = memory.m_state->pieces[support];
  if (!piece) {
    const Eigen::Index count = m_emitters.cols();
    std::vector<Eigen::Index> lit;
    for (Eigen::Index k = 0; k < count; ++k) {
      if ((support >> k & 1U) != 0) {
        lit.push_back(k);
      }
    }
    Eigen::MatrixXd matrix(count, static_cast<Eigen::Index>(lit.size()));
    for (std::size_t k = 0; k < lit.size(); ++k) {
      matrix.col(static_cast<Eigen::Index>(k)) = m_emitters.col(lit[k]);
    }
    piece = std::make_unique<Piece>();
    piece->support = support;
    piece->drives = Square::Zero(count, count);
    if (!lit.empty()) {
      const Eigen::MatrixXd inverse = matrix.completeOrthogonalDecomposition().pseudoInverse();
      for (std::size_t k = 0; k < lit.size(); ++k) {
        piece->drives.row(lit[k]) = inverse.row(static_cast<Eigen::Index>(k));
      }
    }
    piece->slopes = m_emitters.transpose() * (Square::Identity(count, count) - m_emitters * piece->drives);
    for (const Eigen::Index k : lit) {
      piece->slopes.row(k).setZero();
    }
  }
  return *piece;
}

void EnvironmentDriver::solve(const Eigen::Vector3d& rgb, const Eigen::Vector3d& direction, Memory& memory,
                              double* drives) const {
  const Eigen::Index count = m_emitters.cols();
  Eigen::Map<Eigen::VectorXd> result(drives, count);
  Eigen::Vector3d colour;
  for (Eigen::Index c = 0; c < 3; ++c) {
    colour[c] = std::isfinite(rgb[c]) ? std::max(rgb[c], 0.0) : 0.0;
  }
  if (colour.isZero(0)) {
    result.setZero();
    return;
  }
  Vector target = m_targets.front() * colour;
  if (m_targets.size() > 1) {
    target.setZero();
    double sum = 0;
    for (std::size_t d = 0; d < m_targets.size(); ++d) {
      const double weight = 1 / (1 - m_facings[d].dot(direction) + kSameDirection);
      target += weight * (m_targets[d] * colour);
      sum += weight;
    }
    target /= sum;
  }
  const double tolerance = kSlopeTolerance * target.norm() * m_emitters.norm();
  const auto fits = [&](const Piece& piece, Vector& x) {
    x.noalias() = piece.drives * target;
    if (!(x.minCoeff() >= 0)) {
      return false;
    }
    const Vector slopes = piece.slopes * target;
    return slopes.maxCoeff() <= tolerance;
  };
  auto& recent = memory.m_state->recent;
  Vector x(count);
  std::size_t found = recent.size();
  for (std::size_t guess = 0; guess < recent.size() && found == recent.size(); ++guess) {
    if (fits(pieceOf(recent[guess], memory), x)) {
      found = guess;
    }
  }
  if (found < recent.size()) {
    std::rotate(recent.begin(), recent.begin() + static_cast<std::ptrdiff_t>(found),
                recent.begin() + static_cast<std::ptrdiff_t>(found) + 1);
  } else {
    const Eigen::VectorXd whole = nonNegativeLeastSquares(m_emitters, target).x;
    std::uint32_t support = 0;
    for (Eigen::Index k = 0; k < count; ++k) {
      support |= whole[k] > 0 ? 1U << k : 0U;
    }
    const bool isLinear = fits(pieceOf(support, memory), x);
    if (isLinear) {
      recent.insert(recent.begin(), support);
      recent.resize(std::min(recent.size(), kMostGuesses));
    } else {
      x = whole;  // on the border of two sets, where rounding decides
    }
  }
  const bool isTooMuch = (m_limits.upper.size() > 0 && (x.array() > m_limits.upper.array()).any()) ||
                         (m_limits.power.size() > 0 && m_limits.power.dot(x) > m_limits.powerBudget);
  result = isTooMuch ? nonNegativeLeastSquares(m_emitters, target, m_limits).x : Eigen::VectorXd(x);
}

}  // namespace metamer::stage
