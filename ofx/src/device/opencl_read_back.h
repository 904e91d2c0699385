// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "device/opencl_images.h"
#include "pixels/render.h"

namespace metamer::ofx {

/// A render whose images are the host's buffers, done by the processor: what is read is brought here, what was rendered
/// is written up. Waits for all that the queue holds.
/// @throws OpenClError where the queue moves nothing
void renderReadBack(const HostSuites& host, const OpenCl& library, OpenCl::Handle queue, const RenderJob& given,
                    const std::function<bool()>& isAborted);

}  // namespace metamer::ofx
