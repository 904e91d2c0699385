// SPDX-License-Identifier: Apache-2.0
#include "drivers/cuda_interface.h"

#include <array>
#include <optional>

#include "device/buffer_image.h"
#include "device/window_launch.h"
#include "drivers/cuda_programs.h"
#include "drivers/loaded_interface.h"

namespace metamer::ofx {
namespace {

/// Threads that run together, along a row.
constexpr std::uint32_t kBlock = 64;
/// Rows of blocks that every device takes.
constexpr std::int32_t kMostRows = 65535;

Cuda::Address addressOf(const void* pointer) {
  return static_cast<Cuda::Address>(reinterpret_cast<std::uintptr_t>(pointer));
}

BufferExtent extentOf(const DeviceImage& image) {
  const auto begin = static_cast<std::size_t>(addressOf(image.memory));
  return {nullptr, begin, begin + image.bytes()};
}

/// In the context that is the thread's; where it has none, in that of the first image's memory.
class Queue final : public DeviceQueue {
 public:
  Queue(std::shared_ptr<const Cuda> library, CudaPrograms& programs, Cuda::Stream stream)
      : m_library(std::move(library)), m_programs(programs), m_stream(stream) {
    checkCuda(m_library->currentContext(&m_context), "asking for the context");
  }

  DeviceImage image(const PixelView& view) override {
    DeviceImage image = DeviceImage::from(view.data, view);
    if (!image.isThere()) {
      return image;
    }
    enterContextOf(addressOf(view.data));
    image.memory = view.data - image.origin;
    // Memory that was mapped by hand has no range to tell.
    Cuda::Address base = 0;
    std::size_t bytes = 0;
    const Cuda::Address begin = addressOf(image.memory);
    if (m_library->addressRange(&base, &bytes, addressOf(view.data)) == Cuda::kSuccess &&
        (begin < base || begin + image.bytes() > base + bytes)) {
      throw HostError(kOfxStatErrImageFormat, "an image with rows beyond its memory");
    }
    return image;
  }

  bool interferes(const DeviceImage& input, const DeviceImage& output) const override {
    return buffersInterfere(input, extentOf(input), output, extentOf(output));
  }

  const void* place() const override {
    std::uint64_t id = 0;
    const bool hasId = m_library->contextId != nullptr && m_library->contextId(m_context, &id) == Cuda::kSuccess;
    // A name of the context, never followed. NOLINTNEXTLINE(performance-no-int-to-ptr)
    return hasId ? reinterpret_cast<const void*>(static_cast<std::uintptr_t>(id)) : m_context;
  }

  std::shared_ptr<void> upload(std::span<const std::byte> bytes) override {
    Cuda::Address made = 0;
    checkCuda(m_library->allocate(&made, bytes.size()), "memory for tables");
    // What frees it may run on any thread, in the midst of any context; a context that is gone has freed it.
    // CUDA's addresses are numbers. NOLINTNEXTLINE(performance-no-int-to-ptr)
    std::shared_ptr<void> memory(reinterpret_cast<void*>(static_cast<std::uintptr_t>(made)),
                                 [library = m_library, context = m_context](void* address) {
                                   if (library->pushContext(context) == Cuda::kSuccess) {
                                     library->free(addressOf(address));
                                     Cuda::Context popped = nullptr;
                                     library->popContext(&popped);
                                   }
                                 });
    // On a stream of its own: neither waits for what the host holds, nor must its other streams wait for this one.
    Cuda::Stream stream = nullptr;
    checkCuda(m_library->createStream(&stream, Cuda::kStreamNonBlocking), "a stream");
    const Cuda::Status copied = m_library->toDevice(made, bytes.data(), bytes.size(), stream);
    const Cuda::Status waited = m_library->waitForStream(stream);
    m_library->destroyStream(stream);
    checkCuda(copied, "copying tables");
    checkCuda(waited, "copying tables");
    return memory;
  }

  bool launch(const WindowLaunch& launch) override {
    for (std::size_t i = 0; i < launch.images.size(); ++i) {
      const auto bytes = static_cast<std::size_t>(launch.images[i].channelBytes);
      if (launch.images[i].x1 < launch.images[i].x2 && addressOf(launch.pixels[i]) % bytes != 0) {
        return false;
      }
    }
    if (launch.window.rows > kMostRows) {
      return false;
    }
    Cuda::Function const kernel = m_programs.kernel(m_context, place(), launch.kernel);
    std::array<KernelArgument, WindowLaunch::kMostArguments> arguments{};
    std::array<void*, WindowLaunch::kMostArguments> values{};
    const std::size_t count = launch.arguments(arguments);
    for (std::size_t i = 0; i < count; ++i) {
      values[i] = const_cast<void*>(arguments[i].value);  // the driver copies from it
    }
    const std::uint32_t blocks = (static_cast<std::uint32_t>(launch.window.width) + kBlock - 1) / kBlock;
    checkCuda(m_library->launch(kernel, blocks, static_cast<std::uint32_t>(launch.window.rows), 1, kBlock, 1, 1, 0,
                                m_stream, values.data(), nullptr),
              "the kernel");
    if (m_stream == nullptr) {
      finish();
    }
    return true;
  }

  bool isIdle() override {
    requireContext();
    const Cuda::Status status = m_library->queryStream(m_stream);
    checkCuda(status == Cuda::kNotReady ? Cuda::kSuccess : status, "what the stream holds");
    return status == Cuda::kSuccess;
  }

  void read(const DeviceImage& image, std::size_t first, std::span<unsigned char> bytes) override {
    checkCuda(m_library->fromDevice(bytes.data(), addressOf(image.memory) + first, bytes.size(), m_stream),
              "reading an image");
    finish();
  }

  void write(const DeviceImage& image, std::size_t first, std::span<const unsigned char> bytes) override {
    checkCuda(m_library->toDevice(addressOf(image.memory) + first, bytes.data(), bytes.size(), m_stream),
              "writing an image");
  }

  void finish() override { checkCuda(m_library->waitForStream(m_stream), "the stream"); }

 private:
  void requireContext() const {
    if (m_context == nullptr) {
      throw DeviceError("CUDA: no context to render in");
    }
  }

  void enterContextOf(Cuda::Address pointer) {
    if (m_context == nullptr) {
      checkCuda(m_library->pointerInfo(&m_context, Cuda::kPointerContext, pointer), "asking for an image");
      requireContext();
      m_scope.emplace(*m_library, m_context);
    }
  }

  std::shared_ptr<const Cuda> m_library;
  CudaPrograms& m_programs;
  Cuda::Stream m_stream;
  Cuda::Context m_context = nullptr;
  std::optional<CudaScope> m_scope;  ///< where the thread had no context
};

using Interface = LoadedInterface<Cuda, CudaPrograms, Queue>;

}  // namespace

std::unique_ptr<DeviceInterface> loadCuda(const char* variable) {
  auto library = windowText("window.ptx").empty() ? nullptr : Cuda::load(variable);
  return library == nullptr ? nullptr : std::make_unique<Interface>(std::move(library));
}

}  // namespace metamer::ofx
