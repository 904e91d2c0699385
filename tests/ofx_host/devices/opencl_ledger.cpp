// SPDX-License-Identifier: Apache-2.0
#include <dlfcn.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "device_words.h"

namespace {

using Handle = void*;
using Status = std::int32_t;
using Flags = std::uint64_t;
using Count = std::uint32_t;
using Size = std::size_t;

DeviceLedger& ledger() {
  return ledgerOfLibrary();
}

template <typename Function>
Function* systems(const char* name) {
  static void* const library = dlopen("libOpenCL.so.1", RTLD_NOW | RTLD_LOCAL);
  void* const found = library == nullptr ? nullptr : dlsym(library, name);
  return found == nullptr ? (std::abort(), nullptr) : reinterpret_cast<Function*>(found);
}

/// Half of a buffer where the environment asks for it, so that a test can see reads beyond its end found.
Size granted(Size bytes) {
  return std::getenv("METAMER_HALF_BUFFERS") != nullptr ? bytes / 2 : bytes;
}

}  // namespace

extern "C" {

DeviceLedger* metamerLedger() {
  return &ledger();
}

// Functions that let go, which nothing refuses.
#define FORWARD_RELEASE(name, counting)              \
  Status name(Handle released) {                     \
    counting;                                        \
    return systems<Status(Handle)>(#name)(released); \
  }

// Functions that answer with a status.
#define FORWARD(name, parameters, arguments, counting)  \
  Status name parameters {                              \
    if (isRefused(#name)) {                             \
      return ledger().status;                           \
    }                                                   \
    counting;                                           \
    return systems<Status parameters>(#name) arguments; \
  }
// Functions that make something.
#define FORWARD_MAKER(name, parameters, arguments, counting) \
  Handle name parameters {                                   \
    if (isRefused(#name)) {                                  \
      *status = ledger().status;                             \
      return nullptr;                                        \
    }                                                        \
    counting;                                                \
    return systems<Handle parameters>(#name) arguments;      \
  }

FORWARD(clGetCommandQueueInfo, (Handle queue, Count what, Size bytes, void* value, Size* written),
        (queue, what, bytes, value, written), )
FORWARD(clGetDeviceInfo, (Handle device, Count what, Size bytes, void* value, Size* written),
        (device, what, bytes, value, written), )
FORWARD(clGetMemObjectInfo, (Handle buffer, Count what, Size bytes, void* value, Size* written),
        (buffer, what, bytes, value, written), )
FORWARD(clGetProgramBuildInfo, (Handle program, Handle device, Count what, Size bytes, void* value, Size* written),
        (program, device, what, bytes, value, written), )
FORWARD(clGetKernelWorkGroupInfo, (Handle kernel, Handle device, Count what, Size bytes, void* value, Size* written),
        (kernel, device, what, bytes, value, written), )
FORWARD(clGetEventInfo, (Handle event, Count what, Size bytes, void* value, Size* written),
        (event, what, bytes, value, written), )
FORWARD(clEnqueueMarker, (Handle queue, Handle* event), (queue, event), )
FORWARD(clFlush, (Handle queue), (queue), )
FORWARD_MAKER(clCreateProgramWithSource,
              (Handle context, Count texts, const char** text, const Size* lengths, Status* status),
              (context, texts, text, lengths, status), )
FORWARD(clBuildProgram,
        (Handle program, Count devices, const Handle* device, const char* options, void* callback, void* argument),
        (program, devices, device, options, callback, argument), count(ledger().programs))
FORWARD_MAKER(clCreateKernel, (Handle program, const char* kernel, Status* status), (program, kernel, status), )
FORWARD_MAKER(clCreateBuffer, (Handle context, Flags flags, Size bytes, const void* data, Status* status),
              (context, flags, granted(bytes), data, status), (count(ledger().buffers), count(ledger().uploads)))
FORWARD(clSetKernelArg, (Handle kernel, Count index, Size bytes, const void* value), (kernel, index, bytes, value), )
FORWARD(clEnqueueNDRangeKernel,
        (Handle queue, Handle kernel, Count dimensions, const Size* offset, const Size* items, const Size* group,
         Count events, const Handle* waitFor, Handle* event),
        (queue, kernel, dimensions, offset, items, group, events, waitFor, event), count(ledger().kernels))
FORWARD(clEnqueueReadBuffer,
        (Handle queue, Handle buffer, Count waits, Size offset, Size bytes, void* data, Count events,
         const Handle* waitFor, Handle* event),
        (queue, buffer, waits, offset, bytes, data, events, waitFor, event),
        (count(ledger().reads), count(ledger().waits, waits != 0 ? 1 : 0)))
FORWARD(clEnqueueWriteBuffer,
        (Handle queue, Handle buffer, Count waits, Size offset, Size bytes, const void* data, Count events,
         const Handle* waitFor, Handle* event),
        (queue, buffer, waits, offset, bytes, data, events, waitFor, event), count(ledger().writes))
FORWARD(clFinish, (Handle queue), (queue), count(ledger().waits))
FORWARD_RELEASE(clReleaseEvent, )
FORWARD_RELEASE(clReleaseMemObject, count(ledger().buffers, -1))
FORWARD_RELEASE(clReleaseKernel, )
FORWARD_RELEASE(clReleaseProgram, count(ledger().released))

}  // extern "C"
