// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "metamer/ocio/shaper.h"
#include "metamer/sip/error_protocol.h"

namespace metamer::ocio {

/// What the error protocol judges a table of a signal on: colours within the gamut. Of a log signal over the exposures
/// that log footage carries, seven stops each way, short of the curve's last two. Of a display's from what is dark on
/// it, five stops below grey, to white: what its signal ends short of is left out.
sip::ErrorProtocol::Options signalProbes(const Shaper& shaper);

}  // namespace metamer::ocio
