// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cuda_driver.h"
#include "device_host.h"
#include "system.h"

namespace bare_host {

/// A host with CUDA memory, on the tests' own driver. No thread has a context unless a test says so.
class CudaHost final : public AddressHost {
 public:
  CudaHost();
  ~CudaHost() override;
  CudaHost(const CudaHost&) = delete;
  CudaHost& operator=(const CudaHost&) = delete;

  const DeviceWords& words() const override { return m_words; }
  Handle queue(int index) const override { return m_streams[index]; }
  Handle hold(int queue) const override;
  void signal(Handle event) const override;
  Handle buffer(std::size_t bytes, const void* data) const override;
  void read(Handle buffer, std::size_t bytes, void* data, int queue) const override;
  void release(Handle buffer) const override;

  CudaDriver& driver() const { return m_driver; }
  void* context() const { return m_context; }

 private:
  const DeviceWords m_words = {
      .kind = "Cuda",
      .variable = "METAMER_OFX_CUDA",
      .library = METAMER_DEVICE_LIBRARY,
      .hasDoubles = true,
      .needless = {"cuModuleLoadData", "cuModuleGetFunction", "cuMemAlloc", "cuStreamCreate", "cuLaunchKernel"},
      .needed = {"cuCtx", "cu"},
      .compiling = "cuModuleLoadData",
      .failure = 700};
  LoadedLibrary m_library{METAMER_DEVICE_LIBRARY};
  CudaDriver& m_driver = *reinterpret_cast<CudaDriverFunction*>(m_library.symbol("metamerCuda"))();
  Handle m_context = nullptr;
  Handle m_streams[2] = {};
};

}  // namespace bare_host
