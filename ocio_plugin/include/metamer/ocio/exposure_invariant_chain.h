// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <OpenColorIO/OpenColorIO.h>

#include "metamer/sip/spectral_transform.h"

namespace metamer::ocio {

namespace OCIO = OCIO_NAMESPACE;

/// Exposures that the chain keeps apart: stops below and above 0.18, to either side of zero. Darker colours go straight
/// to black, lighter ones stop there.
inline constexpr int kChainStops = 28;

struct ChainOptions {
  int size = 65;       ///< nodes along a side of the 3-D table, kSmallestTable ... kLargestTable
  bool fitted = true;  ///< nodes solved for least error; false: the transform's own values there
};

/// A spectral transform as OCIO operators that scale with exposure exactly: linear RGB in and out, any OCIO from 2.1.
///
/// A matrix to wide channels; the fixed function RGB_TO_HSV, which turns them into hue, saturation and a signed value,
/// whatever their signs; a logarithm of either sign on the value; a 3-D table, tetrahedral, that depends on hue and
/// saturation alone but for the value's logarithm, to which it adds, with a half for either sign of the value; from
/// there the logarithms of three wide channels, their exponentials, and a matrix back. A table that is a plain sum
/// along its third axis is looked up by triangles of the other two, so one exposure is as good as another and a gain
/// goes through as a gain.
///
/// There is no colour that the table does not cover and nothing is divided on the way back: a finite pixel, however
/// noisy or negative, gives no more than the table's own nodes times its size. Black gives black.
/// @param spec       what `transform` was made from
/// @throws spectral::InputError where the size is out of its range
OCIO::GroupTransformRcPtr exposureInvariantChain(const sip::TransformSpec& spec,
                                                 const sip::SpectralTransform& transform,
                                                 const ChainOptions& options = {});

}  // namespace metamer::ocio
