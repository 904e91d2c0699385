// SPDX-License-Identifier: Apache-2.0
#include "device/window_launch.h"

#include <algorithm>

namespace metamer::ofx {

std::size_t WindowLaunch::arguments(std::array<KernelArgument, kMostArguments>& to) const {
  const auto put = [&](WindowArgument argument, const auto& value, bool isMemory) {
    to[static_cast<std::size_t>(argument)] = {&value, sizeof value, isMemory};
  };
  put(WindowArgument::Source, pixels[0], true);
  put(WindowArgument::SourceImage, images[0], false);
  put(WindowArgument::Mask, pixels[1], true);
  put(WindowArgument::MaskImage, images[1], false);
  put(WindowArgument::Output, pixels[2], true);
  put(WindowArgument::OutputImage, images[2], false);
  put(WindowArgument::Window, window, false);
  put(WindowArgument::Nodes, nodes, true);
  put(WindowArgument::Cells, cells, true);
  put(WindowArgument::Curve, curve, true);
  return static_cast<std::size_t>(WindowArgument::Curve) + (curve == nullptr ? 0 : 1);
}

const char* kernelOf(const DeviceForm& form) {
  switch (form.kernel) {
    case DeviceForm::Kernel::Copy:
      return kCopyWindow;
    case DeviceForm::Kernel::Map:
      return form.curve == nullptr ? kMapWindow : kMapCurveWindow;
    case DeviceForm::Kernel::Skin:
      return form.curve == nullptr ? kSkinWindow : kSkinCurveWindow;
    case DeviceForm::Kernel::Affine:
      return kAffineWindow;
  }
  return nullptr;
}

Window windowOf(const RenderJob& job, const OfxRectI& area) {
  Window window;
  window.x1 = area.x1;
  window.y1 = firstRow(job.field, area);
  window.width = area.x2 - area.x1;
  window.rowStep = rowStep(job.field);
  window.rows = std::max(0, (area.y2 - window.y1 + window.rowStep - 1) / window.rowStep);
  window.hasMask = job.hasMask ? 1 : 0;
  window.mix = static_cast<float>(std::clamp(job.mix, 0.0, 1.0));
  const bool isWhole = window.mix >= 1.0F && !job.hasMask;
  window.divides = job.transform != nullptr && !job.transform->isHomogeneous() &&
                           job.premultiplication == Premultiplication::Premultiplied
                       ? 1
                       : 0;
  window.copiesCodes = job.transform == nullptr && isWhole && job.source.format == job.output.format ? 1 : 0;
  return window;
}

std::optional<WindowImage> windowImage(const DeviceImage& image) {
  const PixelFormat& format = image.view.format;
  const OfxRectI& bounds = image.view.bounds;
  if (!image.isThere()) {
    return WindowImage{};
  }
  const std::int32_t channelBytes = format.depth == Depth::Float ? 4 : 2;
  if ((format.depth != Depth::Float && format.depth != Depth::Half) || image.view.rowBytes % channelBytes != 0) {
    return std::nullopt;
  }
  // Memory begins at any byte that the device can address: all hold that to far more than a float.
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

}  // namespace metamer::ofx
