// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <functional>

#include "device/device_interface.h"
#include "pixels/render.h"

namespace metamer::ofx {

/// How long a render waits for what the host has on its queue. Longer than any frame takes: what keeps the queue is
/// then taken for an event that the host signals after the render alone, which would be never.
inline constexpr std::chrono::seconds kLongestWait{10};

/// A render whose images lie on a device, done by the processor: what is read is brought here, what was rendered is
/// written up. Waits for all that the queue holds, as long as the host does not abort.
/// @throws DeviceError where the queue moves nothing, or not within kLongestWait: nothing is left on it then
void renderReadBack(const HostSuites& host, DeviceQueue& queue, const RenderJob& given,
                    const std::function<bool()>& isAborted);

}  // namespace metamer::ofx
