// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "metamer/sip/device_kernels.h"

namespace metamer::sip {

/// The Metal texts, compiled as C++ by the words of metal_shim/metal_stdlib, over RGBA pixels.
std::vector<float> runMetalMap(const DeviceTables& tables, const std::vector<float>& pixels);
std::vector<float> runMetalAffine(const DeviceTables& tables, const std::vector<float>& pixels);

}  // namespace metamer::sip
