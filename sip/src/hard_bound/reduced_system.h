// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "hard_bound/band_table.h"
#include "hard_bound/held_bands.h"

namespace metamer::sip {

/// A curve F that the spectrum follows where nothing pulls it: the prior itself, or the answer to a push at one band.
/// The ends are natural: F[-1] = F[0] and F[B] = F[B-1] + endSlope.
struct Guide {
  Eigen::VectorXd values;
  double endSlope = 0.0;
};

/// A spectrum and what pulls at it.
struct Trial {
  Eigen::Vector4d unknowns;  ///< the multipliers, and the line's height where nothing is held
  Eigen::VectorXd spectrum;
  Eigen::ArrayXd pull;  ///< A^T multipliers
};

/// The Karush-Kuhn-Tucker system of the smoothest spectrum for one choice of held bands.
///
/// Stationarity says that the second difference of R - F is -A^T multipliers on free bands. So on a run of free bands
/// R = F - multipliers . Q + a straight line, Q the run's twice-summed weights (RunSums), and the line is fixed by what
/// the run's held neighbours hold, or by a natural end. (Over all bands: R is the least concave curve above
/// multipliers . Q - F, less that curve.) What remains are three equations for the multipliers, from sums over runs:
/// no elimination, no loss of digits. With nothing held at all the line's height is a fourth unknown.
class ReducedSystem {
 public:
  /// What held bands hold: their bounds, or zero (for a direction of change).
  enum class Held { AtBounds, AtZero };

  /// @param guide  F, or null for zero. All arguments outlive the system.
  ReducedSystem(const BandTable& table, const BandStates& states, const Guide* guide, Held held);

  /// Spectrum whose weights sum to `target`.
  void solve(const Eigen::Vector3d& target, Trial& trial) const;
  /// One step of iterative refinement of what solve() gave: near the spectral locus the free bands' weights are almost
  /// collinear and half the digits are lost.
  void refine(const Eigen::Vector3d& target, Trial& trial) const;

  /// How the bound of a held band pushes: minus the second difference of R, less the pull there.
  double pushAt(int band, const Trial& trial) const {
    const double* r = trial.spectrum.data() + band;
    const double left = band > 0 ? r[0] - r[-1] : 0.0;
    const double right = band + 1 < m_table.bandCount() ? r[0] - r[1] : 0.0;
    return left + right - (trial.pull[band] + guideForce(band));
  }
  /// Minus the second difference of the guide; zero where there is none.
  double guideForce(int band) const;

  /// F^T dR / dtarget, for F of B x 3.
  Eigen::Matrix3d response(const Eigen::MatrixX3d& functionals) const;
  /// dR / dtarget, B x 3 (zero on held bands).
  Eigen::MatrixX3d response() const;

  /// False where the free bands cannot reach every target: the answer is then the nearest in the least-squares sense.
  bool fullRank() const { return m_fullRank; }

 private:
  /// Adjacent free bands, first ... end - 1. R = fixed + multipliers . (base + slope (b - first + 1) - Q).
  struct Run {
    int first;
    int end;
    Eigen::Array4d base;
    Eigen::Array4d slope;
  };

  double heldValue(int band) const {
    return m_held == Held::AtBounds && m_states[static_cast<std::size_t>(band)] == BandState::AtOne ? 1.0 : 0.0;
  }
  void addRun(int first, int end, Eigen::Matrix3d& schur);
  void fix(const Run& run);
  void invert(const Eigen::Matrix3d& schur);
  /// Spectrum and pull from the unknowns.
  void evaluate(Trial& trial) const;
  /// Calls visit(band, what a unit of each multiplier makes there) for every free band.
  template <typename Visit>
  void visitFree(const Visit& visit) const;

  const BandTable& m_table;
  const BandStates& m_states;
  const Guide* m_guide;
  Held m_held;
  bool m_nothingHeld = false;
  std::array<Run, kConvergedBandCount / 2 + 1> m_runs;
  int m_runCount = 0;
  Eigen::VectorXd m_fixed;                // the part of R that does not depend on the multipliers; empty where zero
  Eigen::Matrix<double, 4, 3> m_inverse;  // multipliers, and the line's height, from the target
  Eigen::Vector4d m_start;                // the same for target zero
  bool m_fullRank = true;
};

}  // namespace metamer::sip
