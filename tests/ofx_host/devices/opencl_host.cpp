// SPDX-License-Identifier: Apache-2.0
#include <cstdlib>
#include <stdexcept>

#include "device_host.h"
#include "system.h"

namespace bare_host {
namespace {

// Of OpenCL 1.2, whose headers are a package of their own.
using Handle = void*;
using Status = std::int32_t;
using Flags = std::uint64_t;
constexpr Flags kReadWrite = 1U << 0U;
constexpr Flags kCopiesHost = 1U << 5U;
constexpr Flags kAnyKind = 0xFFFFFFFF;
constexpr std::uint32_t kBaseAlignmentBits = 0x1019;
constexpr std::uint32_t kRegion = 0x1220;

void require(Status status, const char* what) {
  if (status != 0) {
    throw std::runtime_error(std::string("the test's OpenCL: ") + what + " gives " + std::to_string(status));
  }
}

class OpenClHost final : public DeviceHost {
 public:
  OpenClHost();
  ~OpenClHost() override;
  OpenClHost(const OpenClHost&) = delete;
  OpenClHost& operator=(const OpenClHost&) = delete;

  const DeviceWords& words() const override { return m_words; }
  Handle queue(int index) const override { return m_queues[index]; }
  Handle hold(int queue) const override;
  void signal(Handle event) const override;
  Handle buffer(std::size_t bytes, const void* data) const override;
  Handle part(Handle buffer, std::size_t begin, std::size_t bytes) const override;
  void read(Handle buffer, std::size_t bytes, void* data, int queue) const override;
  void release(Handle buffer) const override;
  std::size_t partAlignment() const override;

 private:
  struct Driver;
  const DeviceWords m_words = {
      .kind = "OpenCL",
      .variable = "METAMER_OFX_OPENCL",
      .library = METAMER_DEVICE_LIBRARY,
      .hasDoubles = true,
      .needless = {"clBuildProgram", "clCreateProgramWithSource", "clCreateKernel", "clCreateBuffer", "clSetKernelArg",
                   "clGetKernelWorkGroupInfo", "clEnqueueNDRangeKernel"},
      .needed = {"clEnqueue", "clGet"},
      .compiling = "clBuildProgram",
      .failure = -36};
  std::unique_ptr<const Driver> m_driver;
  Handle m_device = nullptr;
  Handle m_context = nullptr;
  Handle m_queues[2] = {};
};

struct OpenClHost::Driver {
  LoadedLibrary library{"libOpenCL.so.1"};

  template <typename Function>
  Function* find(const char* name) const {
    return reinterpret_cast<Function*>(library.symbol(name));
  }

  Status (*platforms)(std::uint32_t, Handle*,
                      std::uint32_t*) = find<Status(std::uint32_t, Handle*, std::uint32_t*)>("clGetPlatformIDs");
  Status (*devices)(Handle, Flags, std::uint32_t, Handle*, std::uint32_t*) =
      find<Status(Handle, Flags, std::uint32_t, Handle*, std::uint32_t*)>("clGetDeviceIDs");
  Status (*deviceInfo)(Handle, std::uint32_t, std::size_t, void*, std::size_t*) =
      find<Status(Handle, std::uint32_t, std::size_t, void*, std::size_t*)>("clGetDeviceInfo");
  Handle (*createContext)(const std::intptr_t*, std::uint32_t, const Handle*, void*, void*, Status*) =
      find<Handle(const std::intptr_t*, std::uint32_t, const Handle*, void*, void*, Status*)>("clCreateContext");
  Handle (*createQueue)(Handle, Handle, Flags,
                        Status*) = find<Handle(Handle, Handle, Flags, Status*)>("clCreateCommandQueue");
  Handle (*createEvent)(Handle, Status*) = find<Handle(Handle, Status*)>("clCreateUserEvent");
  Status (*setEvent)(Handle, Status) = find<Status(Handle, Status)>("clSetUserEventStatus");
  Handle (*createBuffer)(Handle, Flags, std::size_t, const void*,
                         Status*) = find<Handle(Handle, Flags, std::size_t, const void*, Status*)>("clCreateBuffer");
  Handle (*createPart)(Handle, Flags, std::uint32_t, const void*,
                       Status*) = find<Handle(Handle, Flags, std::uint32_t, const void*, Status*)>("clCreateSubBuffer");
  Status (*barrier)(Handle, std::uint32_t, const Handle*, Handle*) =
      find<Status(Handle, std::uint32_t, const Handle*, Handle*)>("clEnqueueBarrierWithWaitList");
  Status (*read)(Handle, Handle, std::uint32_t, std::size_t, std::size_t, void*, std::uint32_t, const Handle*,
                 Handle*) = find<Status(Handle, Handle, std::uint32_t, std::size_t, std::size_t, void*, std::uint32_t,
                                        const Handle*, Handle*)>("clEnqueueReadBuffer");
  Status (*releaseBuffer)(Handle) = find<Status(Handle)>("clReleaseMemObject");
  Status (*releaseEvent)(Handle) = find<Status(Handle)>("clReleaseEvent");
  Status (*releaseQueue)(Handle) = find<Status(Handle)>("clReleaseCommandQueue");
  Status (*releaseContext)(Handle) = find<Status(Handle)>("clReleaseContext");
};

OpenClHost::OpenClHost() {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  m_reason = "a driver's own compiler does not run under a sanitizer";
  return;
#endif
  try {
    m_driver = std::make_unique<const Driver>();
  } catch (const std::runtime_error& error) {
    m_reason = error.what();
    return;
  }
  Handle platform = nullptr;
  std::uint32_t count = 0;
  if (m_driver->platforms(1, &platform, &count) != 0 || count == 0 ||
      m_driver->devices(platform, kAnyKind, 1, &m_device, &count) != 0 || count == 0) {
    m_reason = "no OpenCL device";
    return;
  }
  Status status = 0;
  m_context = m_driver->createContext(nullptr, 1, &m_device, nullptr, nullptr, &status);
  require(status, "a context");
  for (Handle& queue : m_queues) {
    queue = m_driver->createQueue(m_context, m_device, 0, &status);
    require(status, "a queue");
  }
}

OpenClHost::~OpenClHost() {
  if (m_context != nullptr) {
    for (Handle const queue : m_queues) {
      m_driver->releaseQueue(queue);
    }
    m_driver->releaseContext(m_context);
  }
}

DeviceHost::Handle OpenClHost::hold(int queue) const {
  Status status = 0;
  Handle const event = m_driver->createEvent(m_context, &status);
  require(status, "an event");
  require(m_driver->barrier(m_queues[queue], 1, &event, nullptr), "waiting for an event");
  return event;
}

void OpenClHost::signal(Handle event) const {
  require(m_driver->setEvent(event, 0), "signalling");
  m_driver->releaseEvent(event);
}

DeviceHost::Handle OpenClHost::buffer(std::size_t bytes, const void* data) const {
  Status status = 0;
  Handle const made = m_driver->createBuffer(m_context, kReadWrite | kCopiesHost, bytes, data, &status);
  require(status, "a buffer");
  return made;
}

DeviceHost::Handle OpenClHost::part(Handle buffer, std::size_t begin, std::size_t bytes) const {
  const std::size_t region[2] = {begin, bytes};
  Status status = 0;
  Handle const made = m_driver->createPart(buffer, kReadWrite, kRegion, region, &status);
  require(status, "a part of a buffer");
  return made;
}

void OpenClHost::read(Handle buffer, std::size_t bytes, void* data, int queue) const {
  require(m_driver->read(m_queues[queue], buffer, 1, 0, bytes, data, 0, nullptr, nullptr), "reading");
}

void OpenClHost::release(Handle buffer) const {
  m_driver->releaseBuffer(buffer);
}

std::size_t OpenClHost::partAlignment() const {
  std::uint32_t bits = 0;
  require(m_driver->deviceInfo(m_device, kBaseAlignmentBits, sizeof bits, &bits, nullptr), "the device");
  return bits / 8;
}

}  // namespace

std::unique_ptr<DeviceHost> makeDeviceHost() {
  return std::make_unique<OpenClHost>();
}

}  // namespace bare_host
