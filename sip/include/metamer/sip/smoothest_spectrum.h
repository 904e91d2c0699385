// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "metamer/sip/band_weights.h"

namespace metamer::sip {

class BandTable;

/// Adjacent bands, first ... end - 1, that one bound holds.
struct HeldStretch {
  std::int16_t first;
  std::int16_t end;
  bool atOne;  ///< held at 1; otherwise at 0
  bool operator==(const HeldStretch&) const = default;
};

/// Which bands a bound holds: stretches in order of wavelength, as long as they go. With it given, the spectrum is
/// linear in the tristimulus.
struct ActiveSet {
  std::vector<HeldStretch> stretches;
  bool operator==(const ActiveSet&) const = default;
  bool empty() const { return stretches.empty(); }
  bool holds(int band) const;
};

/// A guess for a colour between two others: the stretches' ends half-way where both have the same stretches, else
/// those of `a`.
ActiveSet between(const ActiveSet& a, const ActiveSet& b);

/// The smoothest spectrum that has a given tristimulus (course notes, section 5.5).
///
/// Minimises sum_b (R[b+1] - R[b])^2 subject to `weights * R = c` and R >= 0 (and R <= 1 where asked); with a prior P,
/// sum_b ((R - P)[b+1] - (R - P)[b])^2 under the same constraints. The problem is strictly convex on the feasible set,
/// so the answer is unique and continuous in c. Solved by its Karush-Kuhn-Tucker conditions: every band that is
/// negative is forced to its bound and every forced band whose multiplier has the wrong sign is released, together,
/// which settles in a few rounds; where it does not, a dual active-set method (Goldfarb and Idnani 1983), which cannot
/// cycle, starts over. With the active set given, the spectrum is straight lines less the twice-summed weights, and
/// three equations remain: O(B) a round.
///
/// Immutable after construction, safe to share between threads. The answer does not depend on any earlier solve.
class SmoothestSpectrumSolver {
 public:
  enum class UpperBound { None, One };
  /// One more than the equations: any weights will do here, such as the seven bands of a worked example.
  static constexpr int kFewestBands = 4;

  /// @param weights  3 x B (eq. 5.3), B kFewestBands ... kConvergedBandCount. A row of zeros is no constraint.
  /// @throws spectral::InputError for another number of bands
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
  /// @return nothing where no spectrum within the bounds has this tristimulus
  /// @throws spectral::InputError where the prior has another number of values
  std::optional<Solution> solve(const Eigen::Vector3d& tristimulus, const Eigen::VectorXd* prior = nullptr,
                                const ActiveSet* start = nullptr) const;

  /// The piece of the answer, linear piece by piece, that holds a tristimulus.
  struct LinearPiece {
    ActiveSet active;
    Eigen::Matrix3d matrix;  ///< F^T dR / dc: F^T R = matrix * c for every c with the same active set
  };
  /// The same solve for some functionals of the spectrum, which cost less than the spectrum itself. No prior, no upper
  /// bound.
  /// @param functionals  F, B x 3
  /// @throws spectral::InputError for another number of rows, and where the solver has an upper bound
  std::optional<LinearPiece> linearise(const Eigen::Vector3d& tristimulus, const Eigen::MatrixX3d& functionals,
                                       const ActiveSet* start = nullptr) const;

  /// The spectrum without bounds: `unconstrained() * c` (B x 3).
  const Eigen::MatrixX3d& unconstrained() const { return m_unconstrained; }

  /// The course notes' loop, for comparison: force the most negative band to zero, never release, repeat.
  /// @return nothing where it ends without a spectrum
  std::optional<Solution> solveByForcingOnly(const Eigen::Vector3d& tristimulus) const;

  const Eigen::Matrix3Xd& weights() const { return m_weights; }
  int bandCount() const { return static_cast<int>(m_weights.cols()); }

 private:
  Eigen::Matrix3Xd m_weights;
  std::shared_ptr<const BandTable> m_table;  // the weights again, laid out for sums over runs of bands
  UpperBound m_upperBound;
  Eigen::MatrixX3d m_unconstrained;
};

/// Sum of squared differences of adjacent bands: what the solver minimises (of R - P where there is a prior).
double roughness(const Eigen::VectorXd& spectrum);

}  // namespace metamer::sip
