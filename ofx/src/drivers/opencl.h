// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "device/device_interface.h"

namespace metamer::ofx {

/// What the plug-in calls of OpenCL 1.1. Its headers are a package of their own: the types, numbers and functions that
/// are used stand here, named as the specification numbers them.
struct OpenCl {
  using Handle = void*;  ///< a context, device, queue, program, kernel or buffer; the library's own
  using Status = std::int32_t;
  using Flags = std::uint64_t;
  /// Releases a handle when it goes.
  using Owned = std::unique_ptr<void, Status (*)(Handle)>;

  static constexpr Status kSuccess = 0;
  static constexpr Status kInvalidKernelName = -46;
  static constexpr Flags kReadOnly = 1U << 2U;
  static constexpr Flags kCopiesHost = 1U << 5U;
  static constexpr Flags kRoundsDivisions = 1U << 7U;  ///< of a device's arithmetic
  static constexpr std::uint32_t kQueueContext = 0x1090;
  static constexpr std::uint32_t kQueueDevice = 0x1091;
  static constexpr std::uint32_t kSingleArithmetic = 0x101B;
  static constexpr std::uint32_t kBufferBytes = 0x1102;
  static constexpr std::uint32_t kBufferParent = 0x1107;
  static constexpr std::uint32_t kBufferOffset = 0x1108;
  static constexpr std::uint32_t kBuildLog = 0x1183;
  static constexpr std::uint32_t kGroupSize = 0x11B0;
  static constexpr std::uint32_t kEventStatus = 0x11D3;
  static constexpr Status kComplete = 0;

  Status (*queueInfo)(Handle queue, std::uint32_t what, std::size_t bytes, void* value, std::size_t* written) = nullptr;
  Status (*deviceInfo)(Handle device, std::uint32_t what, std::size_t bytes, void* value,
                       std::size_t* written) = nullptr;
  Status (*bufferInfo)(Handle buffer, std::uint32_t what, std::size_t bytes, void* value,
                       std::size_t* written) = nullptr;
  Status (*buildInfo)(Handle program, Handle device, std::uint32_t what, std::size_t bytes, void* value,
                      std::size_t* written) = nullptr;
  Status (*groupInfo)(Handle kernel, Handle device, std::uint32_t what, std::size_t bytes, void* value,
                      std::size_t* written) = nullptr;
  Status (*eventInfo)(Handle event, std::uint32_t what, std::size_t bytes, void* value, std::size_t* written) = nullptr;
  Handle (*createProgram)(Handle context, std::uint32_t count, const char** texts, const std::size_t* lengths,
                          Status* status) = nullptr;
  Status (*buildProgram)(Handle program, std::uint32_t count, const Handle* devices, const char* options,
                         void* callback, void* argument) = nullptr;
  Handle (*createKernel)(Handle program, const char* name, Status* status) = nullptr;
  Handle (*createBuffer)(Handle context, Flags flags, std::size_t bytes, const void* data, Status* status) = nullptr;
  Status (*setArgument)(Handle kernel, std::uint32_t index, std::size_t bytes, const void* value) = nullptr;
  Status (*enqueueKernel)(Handle queue, Handle kernel, std::uint32_t dimensions, const std::size_t* offset,
                          const std::size_t* items, const std::size_t* group, std::uint32_t events,
                          const Handle* waitFor, Handle* event) = nullptr;
  Status (*enqueueRead)(Handle queue, Handle buffer, std::uint32_t waits, std::size_t offset, std::size_t bytes,
                        void* data, std::uint32_t events, const Handle* waitFor, Handle* event) = nullptr;
  Status (*enqueueWrite)(Handle queue, Handle buffer, std::uint32_t waits, std::size_t offset, std::size_t bytes,
                         const void* data, std::uint32_t events, const Handle* waitFor, Handle* event) = nullptr;
  Status (*enqueueMarker)(Handle queue, Handle* event) = nullptr;
  Status (*flush)(Handle queue) = nullptr;
  Status (*finish)(Handle queue) = nullptr;
  Status (*releaseBuffer)(Handle buffer) = nullptr;
  Status (*releaseEvent)(Handle event) = nullptr;
  Status (*releaseKernel)(Handle kernel) = nullptr;
  Status (*releaseProgram)(Handle program) = nullptr;

  /// Of the system's library, or what the environment's variable says. Null where there is none or it lacks a function.
  static std::shared_ptr<const OpenCl> load(const char* variable);
};

/// Throws where `status` is a failure. `call` names what was asked. @throws DeviceError
inline void checkOpenCl(OpenCl::Status status, const char* call) {
  if (status != OpenCl::kSuccess) {
    throw DeviceError::of("OpenCL", call, status);
  }
}

/// What the driver tells of a buffer or queue. @throws DeviceError, with the name of the `asking`, where it does not
template <typename Value>
Value openClInfo(decltype(OpenCl::bufferInfo) info, OpenCl::Handle of, std::uint32_t what, const char* asking) {
  Value value{};
  checkOpenCl(info(of, what, sizeof value, &value, nullptr), asking);
  return value;
}

}  // namespace metamer::ofx
