// SPDX-License-Identifier: Apache-2.0
#include <cstring>

#include "device_host.h"
#include "metal_runtime.h"
#include "system.h"

namespace bare_host {
namespace {

/// A host with Metal buffers, on the tests' own library.
class MetalHost final : public DeviceHost {
 public:
  MetalHost() {
    for (Handle& queue : m_queues) {
      queue = m_runtime.makeQueue(m_device);
    }
  }
  ~MetalHost() override {
    for (Handle const queue : m_queues) {
      m_runtime.release(queue);
    }
    m_runtime.release(m_device);
  }
  MetalHost(const MetalHost&) = delete;
  MetalHost& operator=(const MetalHost&) = delete;

  const DeviceWords& words() const override { return m_words; }
  Handle queue(int index) const override { return m_queues[index]; }
  Handle hold(int queue) const override {
    m_runtime.hold(m_queues[queue]);
    return m_queues[queue];
  }
  void signal(Handle event) const override { m_runtime.letGo(event); }
  Handle buffer(std::size_t bytes, const void* data) const override {
    void* const made = m_runtime.makeBuffer(bytes);
    std::memcpy(m_runtime.contents(made), data, bytes);
    return made;
  }
  Handle part(Handle buffer, std::size_t /*begin*/, std::size_t /*bytes*/) const override { return buffer; }
  void read(Handle buffer, std::size_t bytes, void* data, int queue) const override {
    m_runtime.wait(m_queues[queue]);
    std::memcpy(data, m_runtime.contents(buffer), bytes);
  }
  void release(Handle buffer) const override { m_runtime.release(buffer); }
  std::size_t partAlignment() const override { return 0; }

 private:
  const DeviceWords m_words = {
      .kind = "Metal",
      .variable = "METAMER_OFX_METAL",
      .library = METAMER_DEVICE_LIBRARY,
      .hasDoubles = false,
      .needless = {"newLibraryWithSource:", "newFunctionWithName:", "newComputePipelineState", "newBufferWithBytes"},
      .needed = {"commandBuffer", "device", "encoder"},
      .compiling = "newLibraryWithSource:",
      .failure = 0};
  LoadedLibrary m_library{METAMER_DEVICE_LIBRARY};
  MetalRuntime& m_runtime = *reinterpret_cast<MetalRuntimeFunction*>(m_library.symbol("metamerMetal"))();
  Handle m_device = m_runtime.makeDevice();
  Handle m_queues[2] = {};
};

}  // namespace

std::unique_ptr<DeviceHost> makeDeviceHost() {
  return std::make_unique<MetalHost>();
}

}  // namespace bare_host
