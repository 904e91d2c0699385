// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "metamer/sip/smoothest_spectrum.h"

namespace metamer::sip {

/// What holds a band.
enum class BandState : std::int8_t { Free, AtZero, AtOne };
using BandStates = std::array<BandState, kConvergedBandCount>;

/// The Karush-Kuhn-Tucker system of the smoothest spectrum for one choice of held bands.
///
/// With H the tridiagonal matrix of the roughness (diagonal 1, 2, ..., 2, 1, off-diagonal -1), F the free bands and
/// A the weights:  H_FF R_F - A_F^T multipliers = force_F - H_FW R_W,  A_F R_F = target - A_W R_W.
/// Each run of free bands between held ones is a Toeplitz tridiagonal system whose pivots are known in closed form,
/// so elimination needs no division. Where no band is held H is singular along the constant: one band, the pin, then
/// becomes a fourth unknown.
class ReducedSystem {
 public:
  /// What held bands hold: their bounds, or zero (for a direction of change).
  enum class Held { AtBounds, AtZero };

  /// @param weights  a row a band: three channels, then zero
  /// @param force    right side per band, or null for zero (the roughness' own force for a prior P is H P)
  /// @param pin      the band to carry the constant where nothing is held
  /// All three outlive the system.
  ReducedSystem(const std::vector<Eigen::Array4d>& weights, const BandStates& states, const Eigen::VectorXd* force,
                Held held, int pin);

  /// Spectrum whose weights sum to `target`, and the three multipliers. One step of iterative refinement where
  /// `refine`: near the spectral locus the free bands' weights are almost collinear and half the digits are lost.
  void solve(const Eigen::Vector3d& target, bool refine, Eigen::VectorXd& spectrum, Eigen::Vector3d& multipliers) const;

  /// (H R - A^T multipliers - force) at a band: how the bound of a held band pushes.
  double pushAt(int band, const Eigen::VectorXd& spectrum, const Eigen::Vector3d& multipliers) const {
    const double* r = spectrum.data() + band;
    const Eigen::Array4d& weight = m_weights[band];
    const double left = band > 0 ? r[0] - r[-1] : 0.0;
    const double right = band + 1 < m_bandCount ? r[0] - r[1] : 0.0;
    const double force = m_force != nullptr ? (*m_force)[band] : 0.0;
    return left + right - force -
           (weight[0] * multipliers[0] + weight[1] * multipliers[1] + weight[2] * multipliers[2]);
  }

  /// B x 3: the free bands' response to the target (zero on held bands).
  Eigen::MatrixX3d response() const;

  /// False where the free bands cannot reach every target: the answer is then the nearest in the least-squares sense.
  bool fullRank() const { return m_fullRank; }

 private:
  using Columns = std::array<Eigen::Array4d, kConvergedBandCount>;
  /// Adjacent free bands, first ... end - 1.
  struct Run {
    int first;
    int end;
  };

  bool isFree(int band) const { return m_states[band] == BandState::Free && band != m_pin; }
  double heldValue(int band) const {
    return m_held == Held::AtBounds && band >= 0 && band < m_bandCount && m_states[band] == BandState::AtOne ? 1.0
                                                                                                             : 0.0;
  }
  void findRuns();
  void eliminate(Columns& columns) const;
  void formSchur();

  const std::vector<Eigen::Array4d>& m_weights;
  const BandStates& m_states;
  const Eigen::VectorXd* m_force;
  Held m_held;
  int m_bandCount;
  int m_pin;  // -1 where some band is held
  std::array<Run, kConvergedBandCount / 2 + 1> m_runs;
  int m_runCount = 0;
  /// Of free bands: H_FF^-1 applied to the three weights and, last, to the pin's coupling; without a pin, to the force.
  Columns m_columns;
  std::vector<double> m_pinnedForce;  // H_FF^-1 force where both are there
  Eigen::Matrix4d m_inverse;          // of the Schur complement over multipliers and pin
  Eigen::Vector4d m_offset;           // what force and held bands already give, to be taken off the target
  bool m_fullRank = true;
};

/// H x, the gradient of the roughness (half of it).
Eigen::VectorXd roughnessGradient(const Eigen::VectorXd& spectrum);

}  // namespace metamer::sip
