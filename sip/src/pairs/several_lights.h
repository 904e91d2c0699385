// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>

namespace metamer::sip {

/// The smoothest reflectance R, 0 <= R <= brightest, that answers several equations at once: minimises
/// `sum_b (R[b+1] - R[b])^2` subject to `weights * R = colours`. By a primal-dual interior-point method (Mehrotra's
/// steps without the corrector), which needs no guess of what the bounds hold.
struct SeveralLights {
  Eigen::VectorXd reflectance;  ///< B, within the bounds; of the nearest colours there are where there is none
  double missed = 0.0;          ///< largest |weights * R - colours|
};

/// @param weights    n x B, each row's sum about 1; rows may repeat
/// @param colours    n
/// @param brightest  1 or more: above 1 for what gives back more than it gets, in a narrow band
SeveralLights smoothestUnder(const Eigen::MatrixXd& weights, const Eigen::VectorXd& colours, double brightest = 1.0);

/// What missed may be for a colour that is met.
inline constexpr double kMetColour = 1e-9;

}  // namespace metamer::sip
