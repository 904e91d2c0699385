// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "metamer/sip/band_weights.h"
#include "metamer/sip/clamped_bands.h"

namespace metamer::sip {

/// A spectrum at the band centres, on the stack.
using BandVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kConvergedBandCount, 1>;
/// Three of them, a column a channel.
using BandTriple = Eigen::Matrix<double, Eigen::Dynamic, 3, 0, kConvergedBandCount, 3>;

/// `weights * spectra`, without the set-up of a product of large matrices.
/// @param weights  3 x B
Eigen::Matrix3d seen(const Eigen::Matrix3Xd& weights, const Eigen::Ref<const Eigen::MatrixX3d>& spectra);

struct NewtonLanes;

/// The smooth spectrum that has a given tristimulus, softly bounded below (course notes, section 5.5, its bound made
/// soft).
///
/// Minimises `sum_b (D[b+1] - D[b])^2 + omega sum_b min(R[b], 0)^2`, D = R - P, subject to `weights * R = c`: as smooth
/// beside the prior P as can be, and paying for what lies below zero. Unlike a hard bound it has an answer for every c,
/// it is nowhere steep, and it is homogeneous of degree one in (c, P). A relaxed solver pays
/// `relaxation |c - weights * (R - P)|^2` in place of the constraint.
///
/// With the bands below zero given, the optimality conditions are tridiagonal plus three equations. Newton's method
/// guesses these bands, solves, and guesses again until they hold, halving steps that do not descend: a convex problem,
/// piecewise quadratic, so it ends.
///
/// Immutable after construction, safe to share between threads.
class SoftBoundSolver {
 public:
  /// Price of a band below zero for bands `h` nm apart: `omega = kBoundPricePerSquareNm h^2`.
  static constexpr double kBoundPricePerSquareNm = 0.2;

  /// @param weights     3 x B, B within kMinimumBandCount ... kConvergedBandCount, each row's sum 1: the perfect
  ///                    reflector has tristimulus (1, 1, 1)
  /// @param relaxation  0: `weights * R = c` exactly; else the price of what is missed, above 0
  explicit SoftBoundSolver(const Eigen::Matrix3Xd& weights, double relaxation = 0.0);

  struct Solution {
    BandVector reflectance;  ///< R, B values
    ClampedBands clamped;    ///< the bands where R is below zero by more than rounding
    int rounds = 0;          ///< systems solved
  };
  /// @param tristimulus  c, any finite three numbers
  /// @param prior        P, or null for zero; with `weights * P = 0` to rounding where the constraint is exact
  Solution solve(const Eigen::Vector3d& tristimulus, const BandVector* prior = nullptr) const;

  /// One of several colours to be solved at once, and its answer.
  struct Problem {
    Eigen::Vector3d tristimulus = Eigen::Vector3d::Zero();  ///< c
    const double* prior = nullptr;                          ///< P, B values, or null for zero
    double* reflectance = nullptr;                          ///< out: R, B values
    ClampedBands clamped;                                   ///< out
    int rounds = 0;                                         ///< out
  };
  /// Several at once, side by side in the processor's vectors: several times as fast, and the same bits.
  void solve(std::span<Problem> problems) const;

  /// dR / dc where a solution lies, B x 3.
  /// @param priorSlope  dP / dc, B x 3, or null for zero
  BandTriple derivative(const ClampedBands& clamped, const BandTriple* priorSlope = nullptr) const;

  /// The spectrum where no band is clamped and P = 0: `unclamped() * c` (B x 3).
  const BandTriple& unclamped() const { return m_unclamped; }

  const Eigen::Matrix3Xd& weights() const { return m_weights; }
  int bandCount() const { return static_cast<int>(m_weights.cols()); }

 private:
  struct Elimination;

  using Rows = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;

  /// Puts the spectrum without clamped bands into `reflectance`, and says whether it is the answer.
  bool isSmoothEnough(Problem& problem) const;
  /// By Newton's method from there. @param group  at most NewtonLanes::kLanes, all with a prior or all without
  void solveTogether(std::span<Problem* const> group) const;
  void fill(NewtonLanes& lanes, std::span<Problem* const> group) const;

  Eigen::Matrix3Xd m_weights;
  std::vector<Eigen::Array4d> m_load;        ///< a band's weights in three lanes, then zero
  std::vector<Eigen::Array4d> m_loadUpTo;    ///< sum of m_load[0 ... b]
  std::vector<Eigen::Array4d> m_loadBehind;  ///< sum of m_load[b ... B - 1]
  double m_boundPrice;
  double m_slack;       ///< 1 / relaxation; 0 where the constraint is exact
  double m_relaxation;  ///< 0 where it is exact
  BandTriple m_unclamped;
  Rows m_weightRows;  ///< the weights, band by band
  Rows m_smoothRows;  ///< m_unclamped, band by band
};

}  // namespace metamer::sip
