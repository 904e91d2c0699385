// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "metamer/sip/error_protocol.h"
#include "metamer/spectral/log_encoding.h"

namespace metamer::ocio {

/// What the error protocol judges a table of a log signal on: colours within the gamut, over the exposures that log
/// footage carries, seven stops each way, short of the curve's last two.
sip::ErrorProtocol::Options signalProbes(spectral::LogEncoding encoding);

}  // namespace metamer::ocio
