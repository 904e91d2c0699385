// SPDX-License-Identifier: Apache-2.0
#include "reduced_system.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>

namespace metamer::sip {

namespace {

/// m/(m+1) for m = 0, 1, ...: reciprocal pivots of tridiag(-1, 2, -1), and the factors of its elimination.
constexpr std::array<double, kConvergedBandCount + 1> kReciprocalPivots = [] {
  std::array<double, kConvergedBandCount + 1> values{};
  for (std::size_t m = 0; m < values.size(); ++m) {
    values[m] = static_cast<double>(m) / static_cast<double>(m + 1);
  }
  return values;
}();

/// Relative size below which a pivot of the scaled Schur complement counts as zero.
constexpr double kRankTolerance = 1e-13;

/// Pseudo-inverse of a symmetric matrix.
Eigen::Matrix4d pseudoInverse(const Eigen::Matrix4d& symmetric, bool& fullRank) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> eigen(symmetric);
  const double largest = eigen.eigenvalues().cwiseAbs().maxCoeff();
  Eigen::Vector4d reciprocal;
  for (int i = 0; i < 4; ++i) {
    const double value = eigen.eigenvalues()[i];
    const bool zero = std::abs(value) <= kRankTolerance * largest;
    reciprocal[i] = zero ? 0.0 : 1.0 / value;
    fullRank = fullRank && !zero;
  }
  return eigen.eigenvectors() * reciprocal.asDiagonal() * eigen.eigenvectors().transpose();
}

/// Inverse of the symmetric Schur complement over the three multipliers, scaled to unit diagonal first. A channel
/// without weights (zero diagonal) is no constraint: its row stays zero.
Eigen::Matrix4d invertMultipliers(const Eigen::Matrix3d& schur, bool& fullRank) {
  Eigen::Vector3d scale;
  Eigen::Matrix3d scaled = schur;
  for (int i = 0; i < 3; ++i) {
    scale[i] = schur(i, i) > 0.0 ? 1.0 / std::sqrt(schur(i, i)) : 0.0;
  }
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      scaled(i, j) *= scale[i] * scale[j];
    }
    if (scale[i] == 0.0) {
      scaled(i, i) = 1.0;
    }
  }
  Eigen::Matrix3d inverse;
  double determinant = 0.0;
  bool invertible = false;
  scaled.computeInverseAndDetWithCheck(inverse, determinant, invertible, kRankTolerance);
  fullRank = true;
  if (!invertible) {
    Eigen::Matrix4d padded = Eigen::Matrix4d::Identity();
    padded.topLeftCorner<3, 3>() = scaled;
    inverse = pseudoInverse(padded, fullRank).topLeftCorner<3, 3>();
  }
  Eigen::Matrix4d result = Eigen::Matrix4d::Zero();
  result.topLeftCorner<3, 3>() = scale.asDiagonal() * inverse * scale.asDiagonal();
  return result;
}

}  // namespace

Eigen::VectorXd roughnessGradient(const Eigen::VectorXd& spectrum) {
  const Eigen::Index last = spectrum.size() - 1;
  Eigen::VectorXd gradient(spectrum.size());
  gradient[0] = spectrum[0] - spectrum[1];
  for (Eigen::Index b = 1; b < last; ++b) {
    gradient[b] = 2.0 * spectrum[b] - spectrum[b - 1] - spectrum[b + 1];
  }
  gradient[last] = spectrum[last] - spectrum[last - 1];
  return gradient;
}

ReducedSystem::ReducedSystem(const std::vector<Eigen::Array4d>& weights, const BandStates& states,
                             const Eigen::VectorXd* force, Held held, int pin)
    : m_weights(weights),
      m_states(states),
      m_force(force),
      m_held(held),
      m_bandCount(static_cast<int>(weights.size())),
      m_pin(pin) {
  findRuns();
  for (int run = 0; run < m_runCount; ++run) {
    for (int b = m_runs[run].first; b < m_runs[run].end; ++b) {
      m_columns[b] = weights[b];
      if (force != nullptr && m_pin < 0) {
        m_columns[b][3] = (*force)[b];
      }
    }
    // Held neighbours push with what they hold.
    if (m_pin < 0) {
      m_columns[m_runs[run].first][3] += heldValue(m_runs[run].first - 1);
      m_columns[m_runs[run].end - 1][3] += heldValue(m_runs[run].end);
    }
  }
  if (m_pin > 0) {
    m_columns[m_pin - 1][3] = 1.0;
  }
  if (m_pin >= 0 && m_pin + 1 < m_bandCount) {
    m_columns[m_pin + 1][3] = 1.0;
  }
  eliminate(m_columns);
  if (m_pin >= 0 && force != nullptr) {
    Columns forced;
    for (int b = 0; b < m_bandCount; ++b) {
      forced[b].setConstant(isFree(b) ? (*force)[b] : 0.0);
    }
    eliminate(forced);
    m_pinnedForce.resize(weights.size());
    for (int b = 0; b < m_bandCount; ++b) {
      m_pinnedForce[b] = forced[b][0];
    }
  }
  formSchur();
}

void ReducedSystem::findRuns() {
  const auto held = [this](int b) { return m_states[b] != BandState::Free; };
  for (int b = 0; b < m_bandCount; ++b) {
    if (held(b)) {
      m_pin = -1;
      break;
    }
  }
  int b = 0;
  while (b < m_bandCount) {
    while (b < m_bandCount && !isFree(b)) {
      ++b;
    }
    if (b == m_bandCount) {
      break;
    }
    const int first = b;
    while (b < m_bandCount && isFree(b)) {
      ++b;
    }
    m_runs[m_runCount++] = {first, b};
  }
}

void ReducedSystem::eliminate(Columns& columns) const {
  for (int run = 0; run < m_runCount; ++run) {
    const auto [first, end] = m_runs[run];
    // The recurrences run in registers: through memory each step would wait for the last one's store.
    Eigen::Array4d carry = columns[first];
    if (first == 0) {
      // A natural start has diagonal 1, 2, 2, ...: every pivot is 1.
      for (int b = 1; b < end; ++b) {
        carry += columns[b];
        columns[b] = carry;
      }
      for (int b = end - 2; b >= 0; --b) {
        carry += columns[b];
        columns[b] = carry;
      }
      continue;
    }
    for (int b = first + 1; b < end; ++b) {
      carry = columns[b] + kReciprocalPivots[b - first] * carry;
      columns[b] = carry;
    }
    // A natural end has diagonal 1 in place of 2: its pivot is 1/m in place of (m + 1)/m.
    const int count = end - first;
    carry *= end == m_bandCount ? static_cast<double>(count) : kReciprocalPivots[count];
    columns[end - 1] = carry;
    for (int b = end - 2; b >= first; --b) {
      carry = kReciprocalPivots[b - first + 1] * (columns[b] + carry);
      columns[b] = carry;
    }
  }
}

void ReducedSystem::formSchur() {
  // Rows: channels. Columns: the three multipliers, then the pin or the force.
  std::array<Eigen::Array4d, 3> rows = {Eigen::Array4d::Zero(), Eigen::Array4d::Zero(), Eigen::Array4d::Zero()};
  for (int run = 0; run < m_runCount; ++run) {
    for (int b = m_runs[run].first; b < m_runs[run].end; ++b) {
      const Eigen::Array4d& column = m_columns[b];
      const Eigen::Array4d& weight = m_weights[b];
      rows[0] += weight[0] * column;
      rows[1] += weight[1] * column;
      rows[2] += weight[2] * column;
    }
  }
  m_offset.setZero();
  if (m_held == Held::AtBounds) {
    for (int b = 0; b < m_bandCount; ++b) {
      if (m_states[b] == BandState::AtOne) {
        m_offset += m_weights[b].matrix();
      }
    }
  }
  Eigen::Matrix4d schur = Eigen::Matrix4d::Zero();
  for (int k = 0; k < 3; ++k) {
    schur.row(k) = rows[static_cast<std::size_t>(k)].matrix().transpose();
  }
  if (m_pin < 0) {
    m_offset.head<3>() += schur.col(3).head<3>();
    m_inverse = invertMultipliers(schur.topLeftCorner<3, 3>(), m_fullRank);
    return;
  }
  // The pin adds its own weight to the sums, and its stationarity row:
  //   (its free neighbours) + weight . multipliers - degree * pin = -force.
  schur.col(3).head<3>() += m_weights[m_pin].matrix().head<3>();
  schur.row(3).head<3>() = schur.col(3).head<3>().transpose();
  // Zero: with nothing held the whole spectrum follows the pin.
  schur(3, 3) = 0.0;
  m_inverse = pseudoInverse(schur, m_fullRank);
  if (m_force != nullptr) {
    double pinForce = (*m_force)[m_pin];
    for (int b = 0; b < m_bandCount; ++b) {
      m_offset += m_weights[b].matrix() * m_pinnedForce[b];
    }
    for (const int b : {m_pin - 1, m_pin + 1}) {
      pinForce += b >= 0 && b < m_bandCount ? m_pinnedForce[b] : 0.0;
    }
    m_offset[3] = pinForce;
  }
}

void ReducedSystem::solve(const Eigen::Vector3d& target, bool refine, Eigen::VectorXd& spectrum,
                          Eigen::Vector3d& multipliers) const {
  Eigen::Vector4d right = -m_offset;
  right.head<3>() += target;
  Eigen::Vector4d unknowns = m_inverse * right;
  spectrum.resize(m_bandCount);
  for (int b = 0; b < m_bandCount; ++b) {
    spectrum[b] = heldValue(b);
  }
  const auto evaluate = [&] {
    Eigen::Array4d factors = unknowns.array();
    if (m_pin < 0) {
      factors[3] = 1.0;  // the last column is the force's own part
    }
    for (int run = 0; run < m_runCount; ++run) {
      for (int b = m_runs[run].first; b < m_runs[run].end; ++b) {
        spectrum[b] = (m_columns[b] * factors).sum();
      }
    }
    if (m_pin >= 0) {
      spectrum[m_pin] = unknowns[3];
      for (std::size_t b = 0; b < m_pinnedForce.size(); ++b) {
        spectrum[static_cast<Eigen::Index>(b)] += m_pinnedForce[b];
      }
    }
  };
  evaluate();
  if (refine) {
    Eigen::Array4d sum = Eigen::Array4d::Zero();
    for (int b = 0; b < m_bandCount; ++b) {
      sum += m_weights[b] * spectrum[b];
    }
    Eigen::Vector4d residual = -sum.matrix();
    residual.head<3>() += target;
    unknowns += m_inverse * residual;
    evaluate();
  }
  multipliers = unknowns.head<3>();
}

Eigen::MatrixX3d ReducedSystem::response() const {
  Eigen::MatrixX3d matrix = Eigen::MatrixX3d::Zero(m_bandCount, 3);
  // The last column counts where it is the pin's; the force's part is no response.
  const Eigen::Matrix<double, 4, 3> inverse = m_inverse.leftCols<3>();
  for (int run = 0; run < m_runCount; ++run) {
    for (int b = m_runs[run].first; b < m_runs[run].end; ++b) {
      matrix.row(b) = m_columns[b].matrix().transpose() * inverse;
    }
  }
  if (m_pin >= 0) {
    matrix.row(m_pin) = inverse.row(3);
  }
  return matrix;
}

}  // namespace metamer::sip
