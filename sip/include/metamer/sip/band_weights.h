// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "metamer/spectral/observer.h"

namespace metamer::sip {

/// Reflectances are piecewise linear on B equally spaced bands over 380 ... 780 nm.
/// Fewer, in steps of more than 27 nm, hardly tell three channels apart.
inline constexpr int kMinimumBandCount = 16;
/// Holds a tenth of a CIEDE2000 (99th percentile) against the converged engine for spiky lights too; 81 bands do for
/// smooth ones.
inline constexpr int kDefaultBandCount = 201;
inline constexpr int kConvergedBandCount = 401;

/// Centre of a band in nm: 380 + 400 band / (bandCount - 1).
/// @param band       0 ... bandCount - 1
/// @param bandCount  kMinimumBandCount ... kConvergedBandCount
/// @throws spectral::InputError outside these
double bandCentreNm(int band, int bandCount);

/// `weights(k, b)` is the integral of hat function b times `light` times curve k: what band b at reflectance 1 adds to
/// channel k, unscaled. The hats sum to one, so row sums are the response to the perfect reflector whatever the count.
/// @param light     power reaching the observer from the perfect reflector, on the 1 nm domain
/// @param curves    observer curves on the domain, a column a channel
/// @param bandCount kMinimumBandCount ... kConvergedBandCount
/// @throws spectral::InputError for another count
Eigen::Matrix3Xd bandWeights(const spectral::DomainSamples& light,
                             const Eigen::Matrix<double, spectral::kDomainSize, 3>& curves, int bandCount);

/// A spectrum on the domain as its values at the band centres (the domain's own samples, linear between them).
/// @throws spectral::InputError where bandCount is not kMinimumBandCount ... kConvergedBandCount
Eigen::VectorXd atBandCentres(const spectral::DomainSamples& samples, int bandCount);

}  // namespace metamer::sip
