// SPDX-License-Identifier: Apache-2.0
#include "drivers/cuda.h"

#include "drivers/system_library.h"

namespace metamer::ofx {
namespace {

#if defined(_WIN32)
constexpr const char* kSystemName = "nvcuda.dll";
#elif defined(__APPLE__)
constexpr const char* kSystemName = "";
#else
constexpr const char* kSystemName = "libcuda.so.1";
#endif

}  // namespace

std::shared_ptr<const Cuda> Cuda::load(const char* variable) {
  const auto library = SystemLibrary::loadOr(variable, kSystemName);
  if (!library) {
    return nullptr;
  }
  auto functions = std::make_shared<Cuda>();
  bool hasAll = true;
  const auto find = [&](auto& pointer, const char* symbol) { hasAll = library->find(pointer, symbol) && hasAll; };
  find(functions->init, "cuInit");
  find(functions->deviceCount, "cuDeviceGetCount");
  find(functions->currentContext, "cuCtxGetCurrent");
  find(functions->pushContext, "cuCtxPushCurrent_v2");
  find(functions->popContext, "cuCtxPopCurrent_v2");
  find(functions->pointerInfo, "cuPointerGetAttribute");
  find(functions->addressRange, "cuMemGetAddressRange_v2");
  find(functions->loadModule, "cuModuleLoadData");
  find(functions->unloadModule, "cuModuleUnload");
  find(functions->function, "cuModuleGetFunction");
  find(functions->allocate, "cuMemAlloc_v2");
  find(functions->free, "cuMemFree_v2");
  find(functions->createStream, "cuStreamCreate");
  find(functions->destroyStream, "cuStreamDestroy_v2");
  find(functions->queryStream, "cuStreamQuery");
  find(functions->waitForStream, "cuStreamSynchronize");
  find(functions->toDevice, "cuMemcpyHtoDAsync_v2");
  find(functions->fromDevice, "cuMemcpyDtoHAsync_v2");
  find(functions->launch, "cuLaunchKernel");
  library->find(functions->contextId, "cuCtxGetId");
  int devices = 0;
  if (!hasAll || functions->init(0) != kSuccess || functions->deviceCount(&devices) != kSuccess || devices < 1) {
    return nullptr;
  }
  return functions;
}

}  // namespace metamer::ofx
