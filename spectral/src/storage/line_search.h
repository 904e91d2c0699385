// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

namespace metamer::spectral {

/// Least squares without negative numbers, by Lawson and Hanson's active sets (1974, chapter 23).
/// @param matrix  more rows than columns
Eigen::VectorXd nonNegative(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& target);

/// A light as hats and lines.
struct HatsAndLines {
  Eigen::VectorXd hats;
  std::vector<int> lines;  ///< samples of the domain
  Eigen::VectorXd powers;
  double residual = 0;
};

/// Lines are added where they explain most of what is left, and moved while that helps.
/// @param seenHats  what is seen of each hat, a column each
/// @param seen      of each wavelength
HatsAndLines fitLines(const Eigen::MatrixXd& seenHats, const Eigen::MatrixXd& seen, const Eigen::VectorXd& target,
                      int lineCount);

}  // namespace metamer::spectral
