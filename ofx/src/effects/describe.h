// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "drivers/devices.h"
#include "effects/effect.h"
#include "host/host.h"

namespace metamer::ofx {

/// The describe action: what the effect is and can. @param devices  it renders there too @throws HostError
void describe(const HostSuites& host, const Effect& effect, OfxImageEffectHandle descriptor, const Devices& devices);

/// The describe-in-context action: clips and parameters, the same in every context. @throws HostError
void describeInContext(const HostSuites& host, const Effect& effect, OfxImageEffectHandle descriptor);

}  // namespace metamer::ofx
