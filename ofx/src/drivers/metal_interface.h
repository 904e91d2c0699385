// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "device/device_interface.h"

namespace metamer::ofx {

/// Metal buffers: an image's data is the id<MTLBuffer>, its rows lie from the buffer's first byte on; where row bytes
/// are negative the topmost comes first. The queue is the id<MTLCommandQueue>. Null on systems but macOS, and where the
/// environment's variable says "off"; the variable may name another Objective-C library, there too.
std::unique_ptr<DeviceInterface> loadMetal(const char* variable);

}  // namespace metamer::ofx
