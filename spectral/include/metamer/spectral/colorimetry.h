// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "metamer/spectral/observer.h"
#include "metamer/spectral/spectrum.h"

namespace metamer::spectral {

/// Response of an observer to a power distribution, unnormalised: the integral over 380 ... 780 nm of power times
/// curve (see seenLight).
Eigen::Vector3d response(const Spectrum& power, const Observer& observer);

/// Response to a reflectance (or transmittance) under a light, scaled so that the perfect reflector has a second
/// component of 1 (Y for an Xyz observer). CIE 015:2018, section 7.1.
/// @throws InputError where the light gives the observer no response
Eigen::Vector3d tristimulus(const Spectrum& reflectance, const Spectrum& light, const Observer& observer);

/// Chromaticity (x, y) of a tristimulus; (0, 0) where X+Y+Z is not positive.
Eigen::Vector2d chromaticity(const Eigen::Vector3d& xyz);

/// Tristimulus of a chromaticity with luminance Y. @throws InputError where y is 0 or not finite
Eigen::Vector3d xyzFromChromaticity(const Eigen::Vector2d& xy, double Y = 1.0);

/// CIE 1976 u', v' of a tristimulus.
Eigen::Vector2d chromaticityUv(const Eigen::Vector3d& xyz);

/// CIELAB relative to a white (CIE 015:2018, section 8.2.1). Negative tristimuli continue the linear part.
Eigen::Vector3d lab(const Eigen::Vector3d& xyz, const Eigen::Vector3d& white);

/// CIEDE2000 colour difference (CIE 142-2001; Sharma, Wu and Dalal 2005), kL = kC = kH = 1.
double deltaE2000(const Eigen::Vector3d& lab1, const Eigen::Vector3d& lab2);

/// CIEDE2000 as a vector from one colour to the other, whose length it is: lightness, and the differences of chroma
/// and hue turned to a and b, so that it is smooth about grey. For least squares.
Eigen::Vector3d difference2000(const Eigen::Vector3d& lab1, const Eigen::Vector3d& lab2);

}  // namespace metamer::spectral
