// SPDX-License-Identifier: Apache-2.0
#include "cuda_host.h"

#include <cstring>

namespace bare_host {

CudaHost::CudaHost() : m_context(m_driver.makeContext()) {
  for (Handle& stream : m_streams) {
    stream = m_driver.makeStream(m_context);
  }
}

CudaHost::~CudaHost() {
  for (Handle const stream : m_streams) {
    m_driver.releaseStream(stream);
  }
  m_driver.releaseContext(m_context);
}

DeviceHost::Handle CudaHost::hold(int queue) const {
  m_driver.hold(m_streams[queue]);
  return m_streams[queue];
}

void CudaHost::signal(Handle event) const {
  m_driver.letGo(event);
}

DeviceHost::Handle CudaHost::buffer(std::size_t bytes, const void* data) const {
  void* const made = m_driver.allocate(m_context, bytes);
  std::memcpy(made, data, bytes);
  return made;
}

void CudaHost::read(Handle buffer, std::size_t bytes, void* data, int queue) const {
  m_driver.wait(m_streams[queue]);
  std::memcpy(data, buffer, bytes);
}

void CudaHost::release(Handle buffer) const {
  m_driver.release(buffer);
}

std::unique_ptr<DeviceHost> makeDeviceHost() {
  return std::make_unique<CudaHost>();
}

}  // namespace bare_host
