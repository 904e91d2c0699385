// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "pairs/cover.h"
#include "soft_bound/soft_bound_solver.h"

namespace metamer::sip {

/// What pairs, colours whose spectra are known, deviate from a scene that does not know them, interpolated over
/// chromaticity: a mean of their deviations (metameric blacks), each weighed `(1 + x / kHalf) (1 - x / reach)^2 / x^2`
/// by its distance x (Shepard 1968, with Franke and Little's end), and fading to nothing at the pairs' radius. Weights
/// are not below zero and 1 in all, so nothing overshoots however near two pairs lie; at a pair its own is all. White
/// is a pair that deviates by nothing. A pair in conflict (SettledPairs) has its x from `x^2 = distance^2 +
/// softness^2`.
///
/// Places q are chromaticities as in MeasuredSeeds, in standard deviations of its samples. Homogeneous of degree one,
/// with a continuous slope. Immutable after construction, safe to share between threads.
class PairField {
 public:
  /// @param differences  n q from a response
  /// @param responses    3 x n, white-normalised
  /// @param deviations   B x n: pairs' spectra less what the scene gives their responses
  /// @param radius       above 0, in standard deviations
  PairField(const Eigen::Matrix<double, 2, 3>& differences, const Eigen::Matrix3Xd& responses,
            const Eigen::MatrixXd& deviations, double radius);

  /// Adds to deviations of some responses, a column each.
  void addTo(Eigen::MatrixXd& deviations, const Eigen::Matrix3Xd& responses) const;
  /// Adds to the derivative of a deviation by the response.
  void addTo(BandTriple& slope, const Eigen::Vector3d& response) const;

  /// Where pairs lie, how far each reaches, and which others each is in conflict with: all by their numbers as given.
  /// Dark ones lie nowhere.
  bool isDark(Eigen::Index pair) const { return m_at[static_cast<std::size_t>(pair)] < 0; }
  std::vector<Eigen::Index> conflictsOf(Eigen::Index pair) const;
  /// Whether what holds at a pair is its own.
  bool isExact(Eigen::Index pair) const { return !isDark(pair) && conflictsOf(pair).empty(); }
  Eigen::Index count() const { return static_cast<Eigen::Index>(m_at.size()); }
  /// What conflictsOf() calls white.
  static constexpr Eigen::Index kWhite = -1;

  /// A cover of some pairs alone, each reaching as far as it does here.
  Cover coverOf(const std::vector<Eigen::Index>& pairs) const;
  /// The place of a response that hasChromaticity(), and how it changes.
  Eigen::Vector2d placeOf(const Eigen::Vector3d& response) const { return m_differences * response / response.mean(); }
  Eigen::Matrix<double, 2, 3> placeSlope(const Eigen::Vector3d& response) const;

 private:
  /// At a place: the deviation for a mean of one, and where asked for its derivatives by the place in two columns more.
  Eigen::MatrixXd valueAt(const Eigen::Vector2d& place, bool withSlopes) const;

  Eigen::Matrix<double, 2, 3> m_differences;
  std::vector<Eigen::Index> m_at;    ///< which of the places is a pair's; negative: none
  std::vector<Eigen::Index> m_pair;  ///< which pair lies at a place; white last
  Eigen::Matrix2Xd m_places;
  Eigen::MatrixXd m_deviations;  ///< as settled
  Eigen::VectorXd m_softness;
  Eigen::VectorXd m_reaches;
  std::vector<std::vector<Eigen::Index>> m_conflicts;  ///< places
  Cover m_cover;
};

}  // namespace metamer::sip
