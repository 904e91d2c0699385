// SPDX-License-Identifier: Apache-2.0
#include "device/opencl_images.h"

#include <cstdlib>

namespace metamer::ofx {
namespace {

constexpr const char* kAsking = "asking for a buffer";

/// Where a buffer lies in memory of its own: a part of another, or all of itself.
struct Extent {
  OpenCl::Handle memory;
  std::size_t begin;
  std::size_t end;
};

Extent extentOf(const OpenCl& library, OpenCl::Handle buffer) {
  const auto bytes = openClInfo<std::size_t>(library.bufferInfo, buffer, OpenCl::kBufferBytes, kAsking);
  const auto parent = openClInfo<OpenCl::Handle>(library.bufferInfo, buffer, OpenCl::kBufferParent, kAsking);
  const std::size_t begin =
      parent == nullptr ? 0 : openClInfo<std::size_t>(library.bufferInfo, buffer, OpenCl::kBufferOffset, kAsking);
  return {parent == nullptr ? buffer : parent, begin, begin + bytes};
}

}  // namespace

OpenClImage openClImage(const OpenCl& library, const PixelView& view) {
  OpenClImage image{view.data, view, 0};
  if (!image.isThere()) {
    return image;
  }
  const std::ptrdiff_t below = static_cast<std::ptrdiff_t>(view.bounds.y2) - view.bounds.y1 - 1;
  const std::ptrdiff_t row = (static_cast<std::ptrdiff_t>(view.bounds.x2) - view.bounds.x1) *
                             static_cast<std::ptrdiff_t>(view.format.bytesPerPixel());
  image.origin = view.rowBytes < 0 ? -below * view.rowBytes : 0;
  const auto bytes = static_cast<std::size_t>(below * std::abs(view.rowBytes) + row);
  if (bytes > openClInfo<std::size_t>(library.bufferInfo, image.buffer, OpenCl::kBufferBytes, kAsking)) {
    throw HostError(kOfxStatErrImageFormat, "an image with rows beyond its buffer");
  }
  return image;
}

std::optional<WindowImage> windowImage(const OpenClImage& image) {
  const PixelFormat& format = image.view.format;
  const OfxRectI& bounds = image.view.bounds;
  if (!image.isThere()) {
    return WindowImage{};
  }
  const std::int32_t channelBytes = format.depth == Depth::Float ? 4 : 2;
  if ((format.depth != Depth::Float && format.depth != Depth::Half) || image.view.rowBytes % channelBytes != 0) {
    return std::nullopt;
  }
  // A sub-buffer begins at any byte that the device can address; OpenCL holds it to far more than a float.
  const auto pixel = static_cast<std::int64_t>(format.bytesPerPixel());
  return WindowImage{image.origin - bounds.y1 * std::int64_t{image.view.rowBytes} - bounds.x1 * pixel,
                     image.view.rowBytes,
                     bounds.x1,
                     bounds.y1,
                     bounds.x2,
                     bounds.y2,
                     channelBytes,
                     static_cast<std::int32_t>(format.channels())};
}

bool interferes(const OpenCl& library, const OpenClImage& input, const OpenClImage& output) {
  if (!input.isThere() || !output.isThere()) {
    return false;
  }
  const Extent read = extentOf(library, input.buffer);
  const Extent written = extentOf(library, output.buffer);
  if (read.memory != written.memory || read.end <= written.begin || written.end <= read.begin) {
    return false;
  }
  // On one another only where the pixel (0, 0) has, or would have, the same place in both.
  const auto place = [](const Extent& extent, const OpenClImage& image) {
    return static_cast<std::ptrdiff_t>(extent.begin) + image.byteOf(0, 0);
  };
  return input.view.format != output.view.format || input.view.rowBytes != output.view.rowBytes ||
         place(read, input) != place(written, output);
}

}  // namespace metamer::ofx
