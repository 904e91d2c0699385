// SPDX-License-Identifier: Apache-2.0
#include "device/buffer_image.h"

namespace metamer::ofx {

DeviceImage bufferImage(const PixelView& view, const std::function<std::size_t(void* buffer)>& bytesOf) {
  const DeviceImage image = DeviceImage::from(view.data, view);
  if (image.isThere() && image.bytes() > bytesOf(image.memory)) {
    throw HostError(kOfxStatErrImageFormat, "an image with rows beyond its buffer");
  }
  return image;
}

bool buffersInterfere(const DeviceImage& input, const BufferExtent& read, const DeviceImage& output,
                      const BufferExtent& written) {
  if (read.memory != written.memory || read.end <= written.begin || written.end <= read.begin) {
    return false;
  }
  // On one another only where the pixel (0, 0) has, or would have, the same place in both.
  const auto place = [](const BufferExtent& extent, const DeviceImage& image) {
    return static_cast<std::ptrdiff_t>(extent.begin) + image.byteOf(0, 0);
  };
  return input.view.format != output.view.format || input.view.rowBytes != output.view.rowBytes ||
         place(read, input) != place(written, output);
}

}  // namespace metamer::ofx
