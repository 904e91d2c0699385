// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "device/opencl.h"
#include "device/window_text.h"
#include "pixels/image.h"

namespace metamer::ofx {

/// An image in a buffer of the host's: PixelView's data is the cl_mem. Its rows lie from the buffer's first byte on;
/// where row bytes are negative the topmost comes first.
struct OpenClImage {
  OpenCl::Handle buffer = nullptr;
  PixelView view;
  std::ptrdiff_t origin = 0;  ///< byte of the pixel (bounds.x1, bounds.y1) in the buffer

  bool isThere() const { return buffer != nullptr && !isEmpty(view.bounds); }
  /// Byte of a pixel inside the bounds.
  std::ptrdiff_t byteOf(int x, int y) const {
    return origin + (static_cast<std::ptrdiff_t>(y) - view.bounds.y1) * view.rowBytes +
           (static_cast<std::ptrdiff_t>(x) - view.bounds.x1) * static_cast<std::ptrdiff_t>(view.format.bytesPerPixel());
  }
};

/// @throws HostError kOfxStatErrImageFormat where the rows do not lie within the buffer; OpenClError where the driver
/// does
///         not tell
OpenClImage openClImage(const OpenCl& library, const PixelView& view);

/// As the kernels are told. Empty for what they do not read or write: whole numbers, channels off their alignment.
std::optional<WindowImage> windowImage(const OpenClImage& image);

/// Whether a kernel's writes could be read by another of its work items: memory shared, but not pixel on pixel.
/// @throws OpenClError
bool interferes(const OpenCl& library, const OpenClImage& input, const OpenClImage& output);

}  // namespace metamer::ofx
