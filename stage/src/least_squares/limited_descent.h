// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "metamer/stage/non_negative_least_squares.h"

namespace metamer::stage {

/// argmin |A x - b| subject to x >= 0 and the limits, where the limits hold something back: LSI of Lawson and Hanson
/// (1974), chapter 23, gives a point close to it, a primal active-set method the last digits.
/// @param matrix  with no more rows than columns
Eigen::VectorXd solveLimited(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& target, const DriveLimits& limits);

}  // namespace metamer::stage
