// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "metamer/spectral/observer.h"

namespace metamer::spectral {

/// An observer of three curves whose names say what it is: X, Y, Z where they are "x", "y", "z" or "x_bar", ...; cones
/// where they are "l", "m", "s" or "l_bar", ...; else a camera without a published matrix.
/// @param curves  three
/// @throws InputError for another number
Observer observerOfCurves(std::string name, const std::vector<Spectrum>& curves);

}  // namespace metamer::spectral
