// SPDX-License-Identifier: Apache-2.0
#include "device/read_back.h"

#include <algorithm>
#include <thread>
#include <vector>

namespace metamer::ofx {
namespace {

using Memory = std::vector<unsigned char>;

/// False where the host aborts first. By asking, as a call that waits does so for ever where the host holds its queue.
bool waitFor(DeviceQueue& queue, const std::function<bool()>& isAborted) {
  constexpr std::chrono::microseconds kShortest{50};
  constexpr std::chrono::microseconds kLongest{2000};
  const auto end = std::chrono::steady_clock::now() + kLongestWait;
  for (auto pause = kShortest; !queue.isIdle(); pause = std::min(2 * pause, kLongest)) {
    if (isAborted()) {
      return false;
    }
    if (std::chrono::steady_clock::now() > end) {
      throw DeviceError("the host's queue stands still");
    }
    std::this_thread::sleep_for(pause);
  }
  return true;
}

/// The rows of the window as the memory has them, gaps and all.
PixelView broughtHere(DeviceQueue& queue, const PixelView& view, const OfxRectI& window, Memory& memory) {
  const DeviceImage image = queue.image(view);
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
  queue.read(image, static_cast<std::size_t>(first), memory);
  here.data = memory.data() + (low - first);
  return here;
}

}  // namespace

void renderReadBack(const HostSuites& host, DeviceQueue& queue, const RenderJob& given,
                    const std::function<bool()>& isAborted) {
  const OfxRectI window = intersection(given.window, given.output.bounds);
  if (isEmpty(window) || !waitFor(queue, isAborted)) {
    return;
  }
  RenderJob job = given;
  Memory sourceMemory;
  Memory maskMemory;
  job.source = broughtHere(queue, given.source, window, sourceMemory);
  job.mask = broughtHere(queue, given.mask, window, maskMemory);
  const DeviceImage output = queue.image(given.output);
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
    queue.write(output, static_cast<std::size_t>(output.byteOf(window.x1, y)), {job.output.at(window.x1, y), row});
  }
  queue.finish();
}

}  // namespace metamer::ofx
