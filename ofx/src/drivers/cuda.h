// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "device/device_interface.h"

namespace metamer::ofx {

/// What the plug-in calls of CUDA's driver. Its headers are NVIDIA's: the types, numbers and functions that are used
/// stand here, named as the driver exports them.
struct Cuda {
  using Status = std::int32_t;
  using Context = void*;
  using Module = void*;
  using Function = void*;
  using Stream = void*;
  using Address = std::uint64_t;

  static constexpr Status kSuccess = 0;
  static constexpr Status kNotReady = 600;
  static constexpr std::uint32_t kPointerContext = 1;     ///< of a pointer
  static constexpr std::uint32_t kStreamNonBlocking = 1;  ///< waits for no other, not for the default one either

  Status (*init)(std::uint32_t flags) = nullptr;
  Status (*deviceCount)(int* count) = nullptr;
  Status (*currentContext)(Context* context) = nullptr;
  Status (*pushContext)(Context context) = nullptr;
  Status (*popContext)(Context* context) = nullptr;
  Status (*pointerInfo)(void* value, std::uint32_t what, Address pointer) = nullptr;
  Status (*addressRange)(Address* base, std::size_t* bytes, Address pointer) = nullptr;
  Status (*loadModule)(Module* made, const void* text) = nullptr;
  Status (*unloadModule)(Module module) = nullptr;
  Status (*function)(Function* found, Module module, const char* name) = nullptr;
  Status (*allocate)(Address* made, std::size_t bytes) = nullptr;
  Status (*free)(Address address) = nullptr;
  Status (*createStream)(Stream* made, std::uint32_t flags) = nullptr;
  Status (*destroyStream)(Stream stream) = nullptr;
  Status (*queryStream)(Stream stream) = nullptr;
  Status (*waitForStream)(Stream stream) = nullptr;
  Status (*toDevice)(Address to, const void* from, std::size_t bytes, Stream stream) = nullptr;
  Status (*fromDevice)(void* to, Address from, std::size_t bytes, Stream stream) = nullptr;
  Status (*launch)(Function function, std::uint32_t gridX, std::uint32_t gridY, std::uint32_t gridZ,
                   std::uint32_t blockX, std::uint32_t blockY, std::uint32_t blockZ, std::uint32_t sharedBytes,
                   Stream stream, void** arguments, void** more) = nullptr;
  /// Of drivers since CUDA 12; else null. A number that no other context gets.
  Status (*contextId)(Context context, std::uint64_t* id) = nullptr;

  /// Of the system's driver, or what the environment's variable says. Null where there is none, it lacks a function, or
  /// it has no device.
  static std::shared_ptr<const Cuda> load(const char* variable);
};

/// Throws where `status` is a failure. `call` names what was asked. @throws DeviceError
inline void checkCuda(Cuda::Status status, const char* call) {
  if (status != Cuda::kSuccess) {
    throw DeviceError::of("CUDA", call, status);
  }
}

/// A context that is the thread's as long as this lives.
class CudaScope {
 public:
  /// @throws DeviceError
  CudaScope(const Cuda& library, Cuda::Context context) : m_library(library) {
    checkCuda(library.pushContext(context), "a context");
  }
  ~CudaScope() {
    Cuda::Context context = nullptr;
    m_library.popContext(&context);
  }
  CudaScope(const CudaScope&) = delete;
  CudaScope& operator=(const CudaScope&) = delete;

 private:
  const Cuda& m_library;
};

}  // namespace metamer::ofx
