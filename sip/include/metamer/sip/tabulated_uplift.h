// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "metamer/spectral/rgb_space.h"
#include "metamer/spectral/uplift.h"

namespace metamer::sip {

/// An uplift that is homogeneous of degree one (a scene's, Smits', Mallett and Yuksel's), from a table over
/// chromaticities: for pictures of millions of pixels. Linear between the colours of three nodes, it meets every colour
/// as exactly as `exact` does, greys and black have the same spectra, and the others deviate by what
/// docs/uplift.md states.
/// A node is computed when a colour first asks for it; safe on several threads, the same spectra whatever the order.
/// @param space  the table has its chromaticities: ACES2065-1 has all real ones. Colours with a component below 0 in it
/// are
///               solved.
std::unique_ptr<spectral::Uplift> tabulated(std::unique_ptr<spectral::Uplift> exact, const spectral::RgbSpace& space);

}  // namespace metamer::sip
