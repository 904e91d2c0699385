// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

// Peters, Merzbach, Hanika and Dachsbacher 2019, "Using moments to represent bounded signals for spectral rendering",
// ACM Transactions on Graphics 38(4): a signal on phases from -pi to 0, mirrored to 0 ... pi, so that its moments are
// real.
namespace metamer::spectral {

/// The moments of a signal that is linear between phases: c_j = 1/pi times the integral of g(phi) cos(j phi).
/// @param phases  rising from -pi to 0
Eigen::VectorXd trigonometricMoments(const Eigen::VectorXd& phases, const Eigen::VectorXd& signal, int count);

/// The signal between 0 and 1 that has these moments, and of all such the one of the exponential moments' maximum
/// entropy (sections 3.4 and 3.5). NaN where no such signal has them.
Eigen::VectorXd boundedSignal(const Eigen::VectorXd& moments, const Eigen::VectorXd& phases);

/// The positive signal of these moments that has the largest entropy (Burg 1975; section 3.2), its mean about each
/// phase. NaN where there is none.
Eigen::VectorXd positiveSignal(const Eigen::VectorXd& moments, const Eigen::VectorXd& phases);

}  // namespace metamer::spectral
