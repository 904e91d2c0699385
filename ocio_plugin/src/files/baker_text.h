// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "metamer/ocio/lut_writer.h"

namespace metamer::ocio {

/// A group over 0 ... 1 as the text that OCIO's own baker writes, with comments added where the format has a place.
/// @param shaperCurve      what the group starts with and the format is to keep as its own curve; null: it holds the
/// table alone
/// @param shaperSize  without a 1-D shaper: entries of the curve that the format asks for; 0: as the baker likes
/// @throws spectral::InputError where the baker refuses it
std::string bakerText(const std::string& formatName, const OCIO::ConstGroupTransformRcPtr& group,
                      const OCIO::ConstLut1DTransformRcPtr& shaperCurve, int size, int shaperSize,
                      const LutDescription& description);

}  // namespace metamer::ocio
