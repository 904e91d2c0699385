// SPDX-License-Identifier: Apache-2.0
#include "drivers/metal_interface.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <vector>

#include "device/buffer_image.h"
#include "device/window_launch.h"
#include "drivers/loaded_interface.h"
#include "drivers/metal_programs.h"

namespace metamer::ofx {
namespace {

using Object = ObjectiveC::Object;

/// Numbers and structures of Metal's headers.
struct Size {
  unsigned long width;
  unsigned long height;
  unsigned long depth;
};
constexpr unsigned long kGroup = 64;        ///< threads that run together, along a row
constexpr unsigned long kShared = 0;        ///< MTLResourceStorageModeShared
constexpr unsigned long kCompleted = 4;     ///< MTLCommandBufferStatusCompleted
constexpr unsigned long kError = 5;         ///< MTLCommandBufferStatusError
constexpr std::size_t kCopiedTogether = 4;  ///< bytes of buffers are copied by so many

class Queue final : public DeviceQueue {
 public:
  Queue(std::shared_ptr<const ObjectiveC> library, MetalPrograms& programs, Object queue)
      : m_library(std::move(library)),
        m_pool(m_library),
        m_programs(programs),
        m_queue(queue),
        m_device(m_library->send(queue, "device")) {}

  DeviceImage image(const PixelView& view) override {
    return bufferImage(view, [&](Object buffer) { return lengthOf(buffer); });
  }

  bool interferes(const DeviceImage& input, const DeviceImage& output) const override {
    const auto extent = [&](const DeviceImage& image) { return BufferExtent{image.memory, 0, lengthOf(image.memory)}; };
    return buffersInterfere(input, extent(input), output, extent(output));
  }

  const void* place() const override { return m_device; }

  std::shared_ptr<void> upload(std::span<const std::byte> bytes) override {
    return there(m_library->send<Object, const void*, unsigned long, unsigned long>(
        m_device, "newBufferWithBytes:length:options:", bytes.data(), bytes.size(), kShared));
  }

  bool launch(const WindowLaunch& launch) override {
    const auto pipeline = m_programs.pipeline(m_device, launch.kernel);
    if (pipeline == nullptr) {
      return false;
    }
    Object const commands = m_library->send(m_queue, "commandBuffer");
    Object const encoder = m_library->send(commands, "computeCommandEncoder");
    m_library->send<void, Object>(encoder, "setComputePipelineState:", pipeline.get());
    std::array<KernelArgument, WindowLaunch::kMostArguments> arguments{};
    const std::size_t count = launch.arguments(arguments);
    for (unsigned long i = 0; i < count; ++i) {
      if (arguments[i].isMemory) {
        Object buffer = nullptr;
        std::memcpy(&buffer, arguments[i].value, sizeof buffer);
        m_library->send<void, Object, unsigned long, unsigned long>(encoder, "setBuffer:offset:atIndex:", buffer, 0, i);
      } else {
        m_library->send<void, const void*, unsigned long, unsigned long>(
            encoder, "setBytes:length:atIndex:", arguments[i].value, arguments[i].bytes, i);
      }
    }
    const Size groups{(static_cast<unsigned long>(launch.window.width) + kGroup - 1) / kGroup,
                      static_cast<unsigned long>(launch.window.rows), 1};
    m_library->send<void, Size, Size>(encoder, "dispatchThreadgroups:threadsPerThreadgroup:", groups, {kGroup, 1, 1});
    m_library->send<void>(encoder, "endEncoding");
    m_library->send<void>(commands, "commit");
    return true;
  }

  bool isIdle() override {
    if (m_marker == nullptr) {
      m_marker = m_library->send(m_queue, "commandBuffer");
      m_library->send<void>(m_marker, "commit");
    }
    return isComplete(m_marker);
  }

  void read(const DeviceImage& image, std::size_t first, std::span<unsigned char> bytes) override {
    const std::size_t begin = first / kCopiedTogether * kCopiedTogether;
    const std::size_t end = endOf(image, first + bytes.size());
    const auto here = bufferHere(end - begin);
    copy(image.memory, begin, here.get(), 0, end - begin);
    finish();
    std::copy_n(contentOf(here.get()) + (first - begin), bytes.size(), bytes.begin());
  }

  void write(const DeviceImage& image, std::size_t first, std::span<const unsigned char> bytes) override {
    const std::size_t begin = first / kCopiedTogether * kCopiedTogether;
    const std::size_t end = endOf(image, first + bytes.size());
    std::vector<unsigned char> whole(end - begin);
    if (whole.size() != bytes.size()) {
      read(image, begin, whole);
    }
    std::copy(bytes.begin(), bytes.end(), whole.begin() + static_cast<std::ptrdiff_t>(first - begin));
    const auto here = bufferHere(whole.size());
    std::copy(whole.begin(), whole.end(), contentOf(here.get()));
    copy(here.get(), 0, image.memory, begin, whole.size());
  }

  void finish() override {
    Object const commands = m_library->send(m_queue, "commandBuffer");
    m_library->send<void>(commands, "commit");
    m_library->send<void>(commands, "waitUntilCompleted");
    isComplete(commands);
  }

 private:
  std::size_t lengthOf(Object buffer) const { return m_library->send<unsigned long>(buffer, "length"); }

  std::size_t endOf(const DeviceImage& image, std::size_t end) const {
    return std::min((end + kCopiedTogether - 1) / kCopiedTogether * kCopiedTogether, lengthOf(image.memory));
  }

  /// One that the processor sees too.
  std::shared_ptr<void> bufferHere(std::size_t bytes) const {
    return there(m_library->send<Object, unsigned long, unsigned long>(m_device, "newBufferWithLength:options:", bytes,
                                                                       kShared));
  }
  std::shared_ptr<void> there(Object made) const {
    return made != nullptr ? ObjectiveC::owned(m_library, made) : throw DeviceError("Metal: a buffer cannot be had");
  }
  unsigned char* contentOf(Object buffer) const {
    return static_cast<unsigned char*>(m_library->send(buffer, "contents"));
  }

  bool isComplete(Object commands) const {
    const auto status = m_library->send<unsigned long>(commands, "status");
    if (status == kError) {
      throw DeviceError("Metal: what the queue holds fails");
    }
    return status == kCompleted;
  }

  void copy(Object from, unsigned long fromByte, Object to, unsigned long toByte, unsigned long bytes) const {
    Object const commands = m_library->send(m_queue, "commandBuffer");
    Object const encoder = m_library->send(commands, "blitCommandEncoder");
    m_library->send<void, Object, unsigned long, Object, unsigned long, unsigned long>(
        encoder, "copyFromBuffer:sourceOffset:toBuffer:destinationOffset:size:", from, fromByte, to, toByte, bytes);
    m_library->send<void>(encoder, "endEncoding");
    m_library->send<void>(commands, "commit");
  }

  std::shared_ptr<const ObjectiveC> m_library;
  ObjectiveC::Pool m_pool;
  MetalPrograms& m_programs;
  Object m_queue;
  Object m_device;
  Object m_marker = nullptr;
};

using Interface = LoadedInterface<ObjectiveC, MetalPrograms, Queue>;

}  // namespace

std::unique_ptr<DeviceInterface> loadMetal(const char* variable) {
  auto library = ObjectiveC::load(variable);
  return library == nullptr ? nullptr : std::make_unique<Interface>(std::move(library));
}

}  // namespace metamer::ofx
