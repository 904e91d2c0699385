// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

// The parts that non_negative_least_squares.h is made of (Lawson and Hanson 1974, chapter 23).
namespace metamer::stage {

/// A gradient below this, of unit columns and a unit target, is rounding.
inline constexpr double kGradientTolerance = 1e-14;
/// Columns whose part outside the others' span is below this are dependent.
inline constexpr double kDependentBelow = 1e-12;
/// Rounds a column: far more than is ever needed, so that rounding cannot make a cycle.
inline constexpr Eigen::Index kMostRounds = 50;

Eigen::MatrixXd columnsOf(const Eigen::MatrixXd& matrix, const std::vector<Eigen::Index>& columns);

/// NNLS: argmin |A x - b| subject to x >= 0; of several minimisers any one.
Eigen::VectorXd solveNonNegative(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& target);

/// LDP: argmin |z| subject to G z >= h, which must not contradict itself. Rows of G may have any length.
Eigen::VectorXd leastDistance(const Eigen::MatrixXd& constraints, const Eigen::VectorXd& bounds);

}  // namespace metamer::stage
