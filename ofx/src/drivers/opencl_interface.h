// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "device/device_interface.h"

namespace metamer::ofx {

/// OpenCL buffers: an image's data is the cl_mem, its rows lie from the buffer's first byte on; where row bytes are
/// negative the topmost comes first. Null where the system has no OpenCL or the environment's variable says "off"; the
/// variable may name another library.
std::unique_ptr<DeviceInterface> loadOpenCl(const char* variable);

}  // namespace metamer::ofx
