// SPDX-License-Identifier: Apache-2.0
#include "cuda_card_host.h"

#include <cstdlib>
#include <stdexcept>

#include "system.h"

namespace bare_host {
namespace {

using Status = std::int32_t;
using Address = std::uint64_t;
constexpr std::uint32_t kOwnOrder = 1;  ///< a stream that waits for no other

Address addressOf(const void* place) {
  return reinterpret_cast<Address>(place);
}

void require(Status status, const char* call) {
  if (status != 0) {
    throw std::runtime_error(std::string(call) + " answers " + std::to_string(status));
  }
}

std::string libraryName() {
  const char* const named = std::getenv("METAMER_OFX_CUDA");  // NOLINT(concurrency-mt-unsafe)
  return named == nullptr ? "libcuda.so.1" : named;
}

}  // namespace

struct CudaCardHost::Driver {
  LoadedLibrary library{libraryName()};
  Status (*init)(std::uint32_t) = found<decltype(init)>("cuInit");
  Status (*deviceCount)(int*) = found<decltype(deviceCount)>("cuDeviceGetCount");
  Status (*device)(std::int32_t*, int) = found<decltype(device)>("cuDeviceGet");
  Status (*deviceName)(char*, int, std::int32_t) = found<decltype(deviceName)>("cuDeviceGetName");
  Status (*retainContext)(void**, std::int32_t) = found<decltype(retainContext)>("cuDevicePrimaryCtxRetain");
  Status (*releaseContext)(std::int32_t) = found<decltype(releaseContext)>("cuDevicePrimaryCtxRelease_v2");
  Status (*setContext)(void*) = found<decltype(setContext)>("cuCtxSetCurrent");
  Status (*allocate)(Address*, std::size_t) = found<decltype(allocate)>("cuMemAlloc_v2");
  Status (*free)(Address) = found<decltype(free)>("cuMemFree_v2");
  Status (*createStream)(void**, std::uint32_t) = found<decltype(createStream)>("cuStreamCreate");
  Status (*destroyStream)(void*) = found<decltype(destroyStream)>("cuStreamDestroy_v2");
  Status (*waitForStream)(void*) = found<decltype(waitForStream)>("cuStreamSynchronize");
  Status (*toCard)(Address, const void*, std::size_t, void*) = found<decltype(toCard)>("cuMemcpyHtoDAsync_v2");
  Status (*fromCard)(void*, Address, std::size_t, void*) = found<decltype(fromCard)>("cuMemcpyDtoHAsync_v2");
  Status (*onCard)(Address, Address, std::size_t, void*) = found<decltype(onCard)>("cuMemcpyDtoDAsync_v2");

 private:
  template <typename Function>
  Function found(const char* name) const {
    return reinterpret_cast<Function>(library.symbol(name));
  }
};

CudaCardHost::CudaCardHost() : m_driver(std::make_unique<const Driver>()) {
  int count = 0;
  require(m_driver->init(0), "cuInit");
  require(m_driver->deviceCount(&count), "cuDeviceGetCount");
  if (count < 1) {
    throw std::runtime_error("the driver has no card");
  }
  char name[128] = {};
  void* context = nullptr;
  require(m_driver->device(&m_card, 0), "cuDeviceGet");
  require(m_driver->deviceName(name, sizeof name, m_card), "cuDeviceGetName");
  require(m_driver->retainContext(&context, m_card), "cuDevicePrimaryCtxRetain");
  require(m_driver->setContext(context), "cuCtxSetCurrent");
  m_name = name;
  for (Handle& stream : m_streams) {
    require(m_driver->createStream(&stream, kOwnOrder), "cuStreamCreate");
  }
}

CudaCardHost::~CudaCardHost() {
  for (Handle const stream : m_streams) {
    m_driver->destroyStream(stream);
  }
  m_driver->releaseContext(m_card);
}

DeviceHost::Handle CudaCardHost::buffer(std::size_t bytes, const void* data) const {
  Address made = 0;
  require(m_driver->allocate(&made, bytes), "cuMemAlloc");
  require(m_driver->toCard(made, data, bytes, m_streams[0]), "cuMemcpyHtoDAsync");
  wait();
  // NOLINTNEXTLINE(performance-no-int-to-ptr): an address on the card stands where others have a handle.
  return reinterpret_cast<Handle>(made);
}

void CudaCardHost::read(Handle buffer, std::size_t bytes, void* data, int queue) const {
  require(m_driver->fromCard(data, addressOf(buffer), bytes, m_streams[queue]), "cuMemcpyDtoHAsync");
  wait(queue);
}

void CudaCardHost::release(Handle buffer) const {
  require(m_driver->free(addressOf(buffer)), "cuMemFree");
}

DeviceHost::Handle CudaCardHost::hold(int /*queue*/) const {
  throw std::logic_error("a card's queue is not held");
}

void CudaCardHost::signal(Handle /*event*/) const {
  throw std::logic_error("a card's queue is not held");
}

void CudaCardHost::copy(Handle to, Handle from, std::size_t bytes, int queue) const {
  require(m_driver->onCard(addressOf(to), addressOf(from), bytes, m_streams[queue]), "cuMemcpyDtoDAsync");
}

void CudaCardHost::wait(int queue) const {
  require(m_driver->waitForStream(m_streams[queue]), "cuStreamSynchronize");
}

}  // namespace bare_host
