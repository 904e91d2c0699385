// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <bitset>
#include <optional>
#include <vector>

#include "metamer/sip/band_weights.h"

namespace metamer::sip {

/// Which bands a bound holds. With it given, the spectrum is linear in the tristimulus.
struct ActiveSet {
  std::bitset<kConvergedBandCount> atZero;
  std::bitset<kConvergedBandCount> atOne;
  bool operator==(const ActiveSet&) const = default;
  bool empty() const { return atZero.none() && atOne.none(); }
};

/// The smoothest spectrum that has a given tristimulus (course notes, section 5.5).
///
/// Minimises sum_b (R[b+1] - R[b])^2 subject to `weights * R = c` and R >= 0 (and R <= 1 where asked); with a prior P,
/// sum_b ((R - P)[b+1] - (R - P)[b])^2 under the same constraints. The problem is strictly convex on the feasible set,
/// so the answer is unique and continuous in c. Solved by its Karush-Kuhn-Tucker conditions: every band that is
/// negative is forced to its bound and every forced band whose multiplier has the wrong sign is released, together,
/// which settles in a few rounds; where it does not, a dual active-set method (Goldfarb and Idnani 1983), which cannot
/// cycle, starts over. With the active set given, the system is tridiagonal plus three equations: O(B) a round.
///
/// Immutable after construction, safe to share between threads. The answer does not depend on any earlier solve.
class SmoothestSpectrumSolver {
 public:
  enum class UpperBound { None, One };

  /// @param weights  3 x B (eq. 5.3). A row of zeros is no constraint.
  explicit SmoothestSpectrumSolver(Eigen::Matrix3Xd weights, UpperBound upperBound = UpperBound::None);

  struct Solution {
    Eigen::VectorXd reflectance;  ///< R, B values
    ActiveSet active;
    int rounds = 0;         ///< reduced systems solved
    bool fellBack = false;  ///< whether the dual active-set method was needed
  };

  /// @param tristimulus  c, in the units of the weights
  /// @param prior        P, B values, or null for none
  /// @param start        a guess of the active set; changes the time, not the answer
  /// @param linearPiece  where given, gets the B x 3 matrix S of the piece: R = S * c for every c with the same active
  ///                     set (no prior, no upper bound)
  /// @return nothing where no spectrum within the bounds has this tristimulus
  std::optional<Solution> solve(const Eigen::Vector3d& tristimulus, const Eigen::VectorXd* prior = nullptr,
                                const ActiveSet* start = nullptr, Eigen::MatrixX3d* linearPiece = nullptr) const;

  /// The spectrum without bounds: `unconstrained() * c` (B x 3).
  const Eigen::MatrixX3d& unconstrained() const { return m_unconstrained; }

  /// The course notes' loop, for comparison: force the most negative band to zero, never release, repeat.
  /// @return nothing where it ends without a spectrum
  std::optional<Solution> solveByForcingOnly(const Eigen::Vector3d& tristimulus) const;

  const Eigen::Matrix3Xd& weights() const { return m_weights; }
  int bandCount() const { return static_cast<int>(m_weights.cols()); }

 private:
  Eigen::Matrix3Xd m_weights;
  std::vector<Eigen::Array4d> m_lanes;  // the weights a band a row, padded with zero: the reduced system's layout
  UpperBound m_upperBound;
  Eigen::MatrixX3d m_unconstrained;
};

/// Sum of squared differences of adjacent bands: what the solver minimises (of R - P where there is a prior).
double roughness(const Eigen::VectorXd& spectrum);

}  // namespace metamer::sip
