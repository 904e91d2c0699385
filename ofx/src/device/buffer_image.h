// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "device/device_interface.h"

namespace metamer::ofx {

/// Where a buffer lies in memory: the same `memory` is shared.
struct BufferExtent {
  const void* memory;
  std::size_t begin;
  std::size_t end;
};

/// An image whose data is a buffer's handle. Its rows lie from the buffer's first byte on; where row bytes are negative
/// the topmost comes first.
/// @param bytesOf  of a buffer
/// @throws HostError kOfxStatErrImageFormat where the rows do not lie within the buffer
DeviceImage bufferImage(const PixelView& view, const std::function<std::size_t(void* buffer)>& bytesOf);

/// DeviceQueue::interferes() of images whose buffers lie there.
bool buffersInterfere(const DeviceImage& input, const BufferExtent& read, const DeviceImage& output,
                      const BufferExtent& written);

}  // namespace metamer::ofx
