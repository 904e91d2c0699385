// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <OpenColorIO/OpenColorIO.h>

#include <string>
#include <variant>

#include "metamer/ocio/display_curve.h"
#include "metamer/spectral/log_encoding.h"

namespace metamer::ocio {

namespace OCIO = OCIO_NAMESPACE;

/// The curve between the light of a linear space and the signal of a table: a camera's log, or a display's, whose
/// signal ends at white.
using Shaper = std::variant<spectral::LogEncoding, DisplayCurve>;

/// The curve of a name, without regard to case: "ACEScct", "LogC3", ..., "sRGB", "Rec.1886", "Gamma 2.2".
/// @throws spectral::InputError for any other (lists them)
Shaper shaperFromName(const std::string& name);

/// What shaperFromName() takes.
std::string nameOf(const Shaper& shaper);

/// Light of a signal.
double decode(const Shaper& shaper, double signal);

inline bool isDisplay(const Shaper& shaper) {
  return std::holds_alternative<DisplayCurve>(shaper);
}

/// From scene-linear to signal (forward) or back (inverse) as an OCIO operator on all three channels, any OCIO
/// from 2.1.
///
/// A curve of a logarithm over a straight toe is a camera log, within float rounding of the curve everywhere. The Canon
/// curves, which have a logarithm on either side of zero, are half-domain tables: within 1e-5 of the curve (relative,
/// in light) at |light| <= 65504. Displays' curves go on above white and are mirrored below zero; sRGB's is OCIO's own,
/// within 3e-4 of the standard's light where its straight line ends, and exact elsewhere.
OCIO::TransformRcPtr shaperTransform(const Shaper& shaper, OCIO::TransformDirection direction);

}  // namespace metamer::ocio
