// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <OpenColorIO/OpenColorIO.h>

#include "metamer/sip/spectral_transform.h"

namespace metamer::ocio {

namespace OCIO = OCIO_NAMESPACE;

/// Exposures that the chain keeps apart: stops below and above 0.18 in its amount channel. Darker colours go straight
/// to black, lighter ones stop there.
inline constexpr int kChainStops = 28;

struct ChainOptions {
  int size = 65;       ///< nodes along a side of the 3-D table, 3 ... 129
  bool fitted = true;  ///< nodes solved for least error; false: the transform's own values there
};

/// A spectral transform as OCIO operators that scale with exposure exactly: linear RGB in and out, any OCIO from 2.1.
///
/// A matrix to a frame p; the fixed function XYZ_TO_xyY, which turns p into chromaticity and amount; a camera log that
/// is the identity on the two chromaticities and a logarithm (with a linear toe through zero) on the amount; a 3-D
/// table, tetrahedral, that depends on the chromaticities alone but for the third channel, to which it adds; and all of
/// it back. A table that is a plain sum along its third axis is looked up by triangles of the chromaticity plane, so
/// one exposure is as good as another and a gain goes through as a gain.
///
/// Black gives black. Chromaticities outside what the observer can see are clamped to the border of the table; colours
/// with a negative amount (far outside) go to black. Finite pixels give finite results.
/// @param spec       what `transform` was made from
OCIO::GroupTransformRcPtr exposureInvariantChain(const sip::TransformSpec& spec,
                                                 const sip::SpectralTransform& transform,
                                                 const ChainOptions& options = {});

}  // namespace metamer::ocio
