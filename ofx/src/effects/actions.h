// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "effects/effect.h"
#include "host/host.h"

namespace metamer::ofx {

/// Carries out one action on an effect, other than load and unload.
/// @return the status for the host; kOfxStatReplyDefault for actions that are left to it
/// @throws HostError, std::exception
OfxStatus perform(const HostSuites& host, const Effect& effect, const char* action, OfxImageEffectHandle handle,
                  OfxPropertySetHandle inArguments, OfxPropertySetHandle outArguments);

}  // namespace metamer::ofx
