// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "device/device_interface.h"

namespace metamer::ofx {

/// CUDA memory: an image's data is the address of its first pixel on the device, the queue is a stream; without one the
/// default stream is used and waited for, as OpenFX asks. Null where the system has no driver, no device, the build no
/// kernels for it, or the environment's variable says "off"; the variable may name another library.
std::unique_ptr<DeviceInterface> loadCuda(const char* variable);

}  // namespace metamer::ofx
