// SPDX-License-Identifier: Apache-2.0
#include "device/opencl_renderer.h"

#include <algorithm>
#include <array>

#include "device/opencl_images.h"
#include "device/opencl_read_back.h"
#include "host/device_properties.h"

namespace metamer::ofx {
namespace {

/// Work items that run together, where the device has as many.
constexpr std::size_t kGroup = 64;
constexpr const char* kAsking = "asking the queue";

const char* nameOf(const DeviceForm& form) {
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

/// Tables in a context; null: there are none of that kind.
struct Tables final : ResidentTables::Copy {
  Tables(OpenCl::Owned nodesGiven, OpenCl::Owned cellsGiven)
      : nodes(std::move(nodesGiven)), cells(std::move(cellsGiven)) {}

  OpenCl::Owned nodes;
  OpenCl::Owned cells;
};

template <typename Value>
OpenCl::Owned uploaded(const OpenCl& library, OpenCl::Handle context, const std::vector<Value>& values) {
  if (values.empty()) {
    return {nullptr, library.releaseBuffer};
  }
  OpenCl::Status status = OpenCl::kSuccess;
  OpenCl::Owned buffer(library.createBuffer(context, OpenCl::kReadOnly | OpenCl::kCopiesHost,
                                            values.size() * sizeof(Value), values.data(), &status),
                       library.releaseBuffer);
  OpenClError::check(status, "a buffer for tables");
  return buffer;
}

/// As they lie in the context; null where there are none to upload.
std::shared_ptr<const Tables> tablesAt(const OpenCl& library, OpenCl::Handle context, const ResidentTables* resident) {
  if (resident == nullptr) {
    return nullptr;
  }
  return std::static_pointer_cast<const Tables>(resident->copyAt(context, [&](const sip::DeviceTables& tables) {
    return std::make_shared<const Tables>(uploaded(library, context, tables.nodes),
                                          uploaded(library, context, tables.cells));
  }));
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

}  // namespace

std::unique_ptr<OpenClRenderer> OpenClRenderer::load() {
  auto library = OpenCl::load();
  return library == nullptr ? nullptr : std::unique_ptr<OpenClRenderer>(new OpenClRenderer(std::move(library)));
}

std::string OpenClRenderer::render(const HostSuites& host, void* queue, const RenderJob& job,
                                   const std::function<bool()>& isAborted) {
  std::string refused;
  try {
    if (enqueue(queue, job)) {
      return {};
    }
  } catch (const OpenClError& error) {
    refused = error.what();
  }
  try {
    renderReadBack(host, *m_library, queue, job, isAborted);
  } catch (const OpenClError& error) {
    throw HostError(kOfxStatGPURenderFailed, error.what());
  }
  return refused;
}

bool OpenClRenderer::enqueue(OpenCl::Handle queue, const RenderJob& job) {
  const OpenCl& library = *m_library;
  const OfxRectI area = intersection(job.window, job.output.bounds);
  const Window window = windowOf(job, area);
  if (isEmpty(area) || window.rows == 0) {
    return true;
  }
  const std::optional<DeviceForm> form = job.transform == nullptr ? DeviceForm{} : job.transform->deviceForm();
  const std::array<OpenClImage, 3> images = {openClImage(library, job.source), openClImage(library, job.mask),
                                             openClImage(library, job.output)};
  const OpenClImage& output = images.back();
  std::array<WindowImage, 3> forms{};
  bool isUsual = form.has_value();
  for (std::size_t i = 0; i < images.size() && isUsual; ++i) {
    const auto image = windowImage(images[i]);
    isUsual = image && !interferes(library, images[i], output);
    forms[i] = image.value_or(WindowImage{});
  }
  if (!isUsual) {
    return false;
  }
  const auto context = openClInfo<OpenCl::Handle>(library.queueInfo, queue, OpenCl::kQueueContext, kAsking);
  const auto device = openClInfo<OpenCl::Handle>(library.queueInfo, queue, OpenCl::kQueueDevice, kAsking);
  const OpenCl::Owned kernel = m_programs.kernel(context, device, nameOf(*form));
  if (kernel == nullptr) {
    return false;
  }
  const auto tables = tablesAt(library, context, form->tables);
  const auto curve = tablesAt(library, context, form->curve);
  const auto set = [&](WindowArgument argument, const auto& value) {
    OpenClError::check(library.setArgument(kernel.get(), static_cast<std::uint32_t>(argument), sizeof value, &value),
                       "an argument");
  };
  // Where there is no image, no table, any buffer stands for it: it is not looked at.
  const auto given = [&](OpenCl::Handle buffer) { return buffer == nullptr ? output.buffer : buffer; };
  set(WindowArgument::Source, given(images[0].isThere() ? images[0].buffer : nullptr));
  set(WindowArgument::SourceImage, forms[0]);
  set(WindowArgument::Mask, given(images[1].isThere() ? images[1].buffer : nullptr));
  set(WindowArgument::MaskImage, forms[1]);
  set(WindowArgument::Output, output.buffer);
  set(WindowArgument::OutputImage, forms[2]);
  set(WindowArgument::Window, window);
  set(WindowArgument::Nodes, given(tables == nullptr ? nullptr : tables->nodes.get()));
  set(WindowArgument::Cells, given(tables == nullptr ? nullptr : tables->cells.get()));
  if (curve != nullptr) {
    set(WindowArgument::Curve, given(curve->cells.get()));
  }
  std::size_t most = 1;
  OpenClError::check(library.groupInfo(kernel.get(), device, OpenCl::kGroupSize, sizeof most, &most, nullptr),
                     "asking the kernel");
  const std::array<std::size_t, 2> group = {std::min(kGroup, most), 1};
  const auto width = static_cast<std::size_t>(window.width);
  const std::array<std::size_t, 2> items = {(width + group[0] - 1) / group[0] * group[0],
                                            static_cast<std::size_t>(window.rows)};
  OpenClError::check(
      library.enqueueKernel(queue, kernel.get(), 2, nullptr, items.data(), group.data(), 0, nullptr, nullptr),
      "the kernel");
  return true;
}

}  // namespace metamer::ofx
