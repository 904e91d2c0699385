// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

namespace metamer::sip {

/// What pairs may ask of the colours between them. A deviation may change by kSteepest from place to place, as a root
/// mean square over the visible, for a mean of one and per standard deviation of surfaces' chromaticities: twice what
/// the patches of charts ask for. Two pairs that ask for more are in conflict: no reflectance can be told from another
/// so close to it.
inline constexpr double kSteepestPairs = 5.0;

/// Pairs whose conflicts are settled.
struct SettledPairs {
  /// What is meant to hold at each pair. Its own deviation where there is no conflict. Else of all mixtures of those in
  /// conflict with it, itself among them, the one nearest to none: so no pair is farther from its own than without any
  /// (for x nearest to the origin of a convex set, |y - x| <= |y| for all its y). It counts as far as they are alike:
  /// what is nearer in spectrum need not be in colour.
  Eigen::MatrixXd deviations;
  Eigen::VectorXd softness;                          ///< 0: exact; else over what distance it mixes with its neighbours
  std::vector<std::vector<Eigen::Index>> conflicts;  ///< with which others, the nearest first
};

/// @param places      2 x n, in standard deviations
/// @param deviations  B x n, of mean one, from 380 to 780 nm. The last pair is white's: it gives way to none.
SettledPairs settledPairs(const Eigen::Matrix2Xd& places, const Eigen::MatrixXd& deviations);

}  // namespace metamer::sip
