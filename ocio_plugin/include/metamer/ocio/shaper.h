// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <OpenColorIO/OpenColorIO.h>

#include <string>

#include "metamer/spectral/log_encoding.h"

namespace metamer::ocio {

namespace OCIO = OCIO_NAMESPACE;

/// The log curve of a name: "ACEScct", "LogC3", ... without regard to case.
/// @throws spectral::InputError for any other (lists them)
spectral::LogEncoding shaperFromName(const std::string& name);

/// spectral::encode (forward: scene-linear to signal) or spectral::decode (inverse) as an OCIO operator on all three
/// channels, any OCIO from 2.1.
///
/// A curve of a logarithm over a straight toe is a camera log, within float rounding of the curve everywhere. The Canon
/// curves, which have a logarithm on either side of zero, are half-domain tables: within 1e-5 of the curve (relative,
/// in light) at |light| <= 65504.
OCIO::TransformRcPtr shaperTransform(spectral::LogEncoding encoding, OCIO::TransformDirection direction);

}  // namespace metamer::ocio
