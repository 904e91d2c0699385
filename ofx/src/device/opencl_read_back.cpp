// SPDX-License-Identifier: Apache-2.0
#include "device/opencl_read_back.h"

#include <algorithm>
#include <vector>

namespace metamer::ofx {
namespace {

using Memory = std::vector<unsigned char>;

/// The rows of the window as the buffer has them, gaps and all.
PixelView broughtHere(const OpenCl& library, OpenCl::Handle queue, const PixelView& view, const OfxRectI& window,
                      Memory& memory) {
  const OpenClImage image = openClImage(library, view);
  PixelView here = view;
  here.data = nullptr;
  here.bounds = intersection(view.bounds, window);
  if (!image.isThere() || isEmpty(here.bounds)) {
    return here;
  }
  const std::ptrdiff_t low = image.byteOf(here.bounds.x1, here.bounds.y1);
  const std::ptrdiff_t high = image.byteOf(here.bounds.x1, here.bounds.y2 - 1);
  const std::ptrdiff_t first = std::min(low, high);
  const std::size_t row = static_cast<std::size_t>(here.bounds.x2 - here.bounds.x1) * view.format.bytesPerPixel();
  memory.resize(static_cast<std::size_t>(std::max(low, high) - first) + row);
  OpenClError::check(library.enqueueRead(queue, image.buffer, 1, static_cast<std::size_t>(first), memory.size(),
                                         memory.data(), 0, nullptr, nullptr),
                     "reading an image");
  here.data = memory.data() + (low - first);
  return here;
}

}  // namespace

void renderReadBack(const HostSuites& host, const OpenCl& library, OpenCl::Handle queue, const RenderJob& given,
                    const std::function<bool()>& isAborted) {
  const OfxRectI window = intersection(given.window, given.output.bounds);
  if (isEmpty(window)) {
    return;
  }
  RenderJob job = given;
  Memory sourceMemory;
  Memory maskMemory;
  job.source = broughtHere(library, queue, given.source, window, sourceMemory);
  job.mask = broughtHere(library, queue, given.mask, window, maskMemory);
  const OpenClImage output = openClImage(library, given.output);
  const std::size_t row = static_cast<std::size_t>(window.x2 - window.x1) * given.output.format.bytesPerPixel();
  Memory outputMemory(row * static_cast<std::size_t>(window.y2 - window.y1));
  job.output.data = outputMemory.data();
  job.output.bounds = window;
  job.output.rowBytes = static_cast<std::ptrdiff_t>(row);
  bool aborted = false;
  render(host, job, [&] { return aborted = aborted || isAborted(); });
  if (aborted) {
    return;
  }
  // The window's pixels alone: what lies between and around them is the host's.
  for (int y = firstRow(job.field, window); y < window.y2; y += rowStep(job.field)) {
    OpenClError::check(
        library.enqueueWrite(queue, output.buffer, 0, static_cast<std::size_t>(output.byteOf(window.x1, y)), row,
                             job.output.at(window.x1, y), 0, nullptr, nullptr),
        "writing an image");
  }
  OpenClError::check(library.finish(queue), "the queue");
}

}  // namespace metamer::ofx
