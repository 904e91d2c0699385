// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "effects/plugin.h"

namespace metamer::ofx {

/// Carries out one action on an effect of the plug-in, by its index, other than load and unload.
/// @return the status for the host; kOfxStatReplyDefault for actions that are left to it
/// @throws HostError, std::exception
OfxStatus perform(const Plugin& plugin, std::size_t index, const char* action, OfxImageEffectHandle handle,
                  OfxPropertySetHandle inArguments, OfxPropertySetHandle outArguments);

}  // namespace metamer::ofx
