// SPDX-License-Identifier: Apache-2.0
#include "device/device_renderer.h"

#include "device/read_back.h"
#include "device/window_launch.h"
#include "host/device_properties.h"

namespace metamer::ofx {
namespace {

/// Tables on a device; null: there are none of that kind.
struct Tables final : ResidentTables::Copy {
  std::shared_ptr<void> nodes;
  std::shared_ptr<void> cells;
};

template <typename Value>
std::shared_ptr<void> uploaded(DeviceQueue& queue, const std::vector<Value>& values) {
  return values.empty() ? nullptr : queue.upload(std::as_bytes(std::span(values)));
}

/// As they lie where the queue is; null where there are none to upload.
std::shared_ptr<const Tables> tablesAt(DeviceQueue& queue, const ResidentTables* resident) {
  if (resident == nullptr) {
    return nullptr;
  }
  return std::static_pointer_cast<const Tables>(resident->copyAt(queue.place(), [&](const sip::DeviceTables& tables) {
    auto copy = std::make_shared<Tables>();
    copy->nodes = uploaded(queue, tables.nodes);
    copy->cells = uploaded(queue, tables.cells);
    return copy;
  }));
}

/// False where no kernel does it.
bool enqueue(DeviceQueue& queue, const RenderJob& job) {
  const OfxRectI area = intersection(job.window, job.output.bounds);
  WindowLaunch launch;
  launch.window = windowOf(job, area);
  if (isEmpty(area) || launch.window.rows == 0) {
    return true;
  }
  const std::optional<DeviceForm> form = job.transform == nullptr ? DeviceForm{} : job.transform->deviceForm();
  const std::array<DeviceImage, 3> images = {queue.image(job.source), queue.image(job.mask), queue.image(job.output)};
  const DeviceImage& output = images.back();
  bool isUsual = form.has_value();
  for (std::size_t i = 0; i < images.size() && isUsual; ++i) {
    const auto image = windowImage(images[i]);
    isUsual = image && !(images[i].isThere() && output.isThere() && queue.interferes(images[i], output));
    launch.images[i] = image.value_or(WindowImage{});
    launch.pixels[i] = images[i].isThere() ? images[i].memory : output.memory;
  }
  if (!isUsual) {
    return false;
  }
  launch.kernel = kernelOf(*form);
  const auto tables = tablesAt(queue, form->tables);
  const auto curve = tablesAt(queue, form->curve);
  // Where there is no table, any memory stands for it: it is not looked at.
  const auto given = [&](const std::shared_ptr<void>& memory) { return memory ? memory.get() : output.memory; };
  launch.nodes = tables == nullptr ? output.memory : given(tables->nodes);
  launch.cells = tables == nullptr ? output.memory : given(tables->cells);
  launch.curve = curve == nullptr ? nullptr : given(curve->cells);
  return queue.launch(launch);
}

}  // namespace

std::string DeviceRenderer::render(const HostSuites& host, void* queue, const RenderJob& job,
                                   const std::function<bool()>& isAborted) const {
  std::string refused;
  try {
    const std::unique_ptr<DeviceQueue> opened = m_interface->open(queue);
    try {
      if (enqueue(*opened, job)) {
        return {};
      }
    } catch (const DeviceError& error) {
      refused = error.what();
    }
    renderReadBack(host, *opened, job, isAborted);
  } catch (const DeviceError& error) {
    throw HostError(kOfxStatGPURenderFailed, error.what());
  }
  return refused;
}

}  // namespace metamer::ofx
