// SPDX-License-Identifier: Apache-2.0
#include "drivers/opencl_interface.h"

#include <algorithm>
#include <array>

#include "device/buffer_image.h"
#include "device/window_launch.h"
#include "drivers/loaded_interface.h"
#include "drivers/opencl_programs.h"

namespace metamer::ofx {
namespace {

/// Work items that run together, where the device has as many.
constexpr std::size_t kGroup = 64;
constexpr const char* kAskingBuffer = "asking for a buffer";
constexpr const char* kAskingQueue = "asking the queue";

/// Where a buffer lies in memory of its own: a part of another, or all of itself.
BufferExtent extentOf(const OpenCl& library, OpenCl::Handle buffer) {
  const auto bytes = openClInfo<std::size_t>(library.bufferInfo, buffer, OpenCl::kBufferBytes, kAskingBuffer);
  const auto parent = openClInfo<OpenCl::Handle>(library.bufferInfo, buffer, OpenCl::kBufferParent, kAskingBuffer);
  const std::size_t begin =
      parent == nullptr ? 0 : openClInfo<std::size_t>(library.bufferInfo, buffer, OpenCl::kBufferOffset, kAskingBuffer);
  return {parent == nullptr ? buffer : parent, begin, begin + bytes};
}

class Queue final : public DeviceQueue {
 public:
  Queue(const std::shared_ptr<const OpenCl>& library, OpenClPrograms& programs, OpenCl::Handle queue)
      : m_library(*library),
        m_programs(programs),
        m_queue(queue),
        m_context(openClInfo<OpenCl::Handle>(library->queueInfo, queue, OpenCl::kQueueContext, kAskingQueue)),
        m_device(openClInfo<OpenCl::Handle>(library->queueInfo, queue, OpenCl::kQueueDevice, kAskingQueue)) {}

  DeviceImage image(const PixelView& view) override {
    return bufferImage(view, [&](void* buffer) {
      return openClInfo<std::size_t>(m_library.bufferInfo, buffer, OpenCl::kBufferBytes, kAskingBuffer);
    });
  }

  bool interferes(const DeviceImage& input, const DeviceImage& output) const override {
    return buffersInterfere(input, extentOf(m_library, input.memory), output, extentOf(m_library, output.memory));
  }

  const void* place() const override { return m_context; }

  std::shared_ptr<void> upload(std::span<const std::byte> bytes) override {
    OpenCl::Status status = OpenCl::kSuccess;
    std::shared_ptr<void> buffer(
        m_library.createBuffer(m_context, OpenCl::kReadOnly | OpenCl::kCopiesHost, bytes.size(), bytes.data(), &status),
        [release = m_library.releaseBuffer](void* made) {
          if (made != nullptr) {
            release(made);
          }
        });
    checkOpenCl(status, "a buffer for tables");
    return buffer;
  }

  bool launch(const WindowLaunch& launch) override {
    const OpenCl::Owned kernel = m_programs.kernel(m_context, m_device, launch.kernel);
    if (kernel == nullptr) {
      return false;
    }
    std::array<KernelArgument, WindowLaunch::kMostArguments> arguments{};
    const std::size_t count = launch.arguments(arguments);
    for (std::uint32_t i = 0; i < count; ++i) {
      checkOpenCl(m_library.setArgument(kernel.get(), i, arguments[i].bytes, arguments[i].value), "an argument");
    }
    std::size_t most = 1;
    checkOpenCl(m_library.groupInfo(kernel.get(), m_device, OpenCl::kGroupSize, sizeof most, &most, nullptr),
                "asking the kernel");
    const std::array<std::size_t, 2> group = {std::min(kGroup, most), 1};
    const auto width = static_cast<std::size_t>(launch.window.width);
    const std::array<std::size_t, 2> items = {(width + group[0] - 1) / group[0] * group[0],
                                              static_cast<std::size_t>(launch.window.rows)};
    checkOpenCl(
        m_library.enqueueKernel(m_queue, kernel.get(), 2, nullptr, items.data(), group.data(), 0, nullptr, nullptr),
        "the kernel");
    return true;
  }

  bool isIdle() override {
    if (m_marker == nullptr) {
      OpenCl::Handle marker = nullptr;
      checkOpenCl(m_library.enqueueMarker(m_queue, &marker), "a marker");
      m_marker = OpenCl::Owned(marker, m_library.releaseEvent);
      checkOpenCl(m_library.flush(m_queue), "the queue");
    }
    const auto status =
        openClInfo<OpenCl::Status>(m_library.eventInfo, m_marker.get(), OpenCl::kEventStatus, "asking for a marker");
    checkOpenCl(std::min(status, OpenCl::kSuccess), "what the queue holds");
    return status == OpenCl::kComplete;
  }

  void read(const DeviceImage& image, std::size_t first, std::span<unsigned char> bytes) override {
    checkOpenCl(m_library.enqueueRead(m_queue, image.memory, 1, first, bytes.size(), bytes.data(), 0, nullptr, nullptr),
                "reading an image");
  }

  void write(const DeviceImage& image, std::size_t first, std::span<const unsigned char> bytes) override {
    checkOpenCl(
        m_library.enqueueWrite(m_queue, image.memory, 0, first, bytes.size(), bytes.data(), 0, nullptr, nullptr),
        "writing an image");
  }

  void finish() override { checkOpenCl(m_library.finish(m_queue), "the queue"); }

 private:
  const OpenCl& m_library;
  OpenClPrograms& m_programs;
  OpenCl::Handle m_queue;
  OpenCl::Handle m_context;
  OpenCl::Handle m_device;
  OpenCl::Owned m_marker{nullptr, nullptr};
};

using Interface = LoadedInterface<OpenCl, OpenClPrograms, Queue>;

}  // namespace

std::unique_ptr<DeviceInterface> loadOpenCl(const char* variable) {
  auto library = OpenCl::load(variable);
  return library == nullptr ? nullptr : std::make_unique<Interface>(std::move(library));
}

}  // namespace metamer::ofx
