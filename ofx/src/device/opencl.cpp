// SPDX-License-Identifier: Apache-2.0
#include "device/opencl.h"

#include <type_traits>

#include "device/system_library.h"
#include "metamer/spectral/platform.h"

namespace metamer::ofx {
namespace {

constexpr const char* kVariable = "METAMER_OFX_OPENCL";
constexpr const char* kOff = "off";
#if defined(_WIN32)
constexpr const char* kSystemName = "OpenCL.dll";
#elif defined(__APPLE__)
constexpr const char* kSystemName = "/System/Library/Frameworks/OpenCL.framework/OpenCL";
#else
constexpr const char* kSystemName = "libOpenCL.so.1";
#endif

}  // namespace

std::shared_ptr<const OpenCl> OpenCl::load() {
  const std::string name = spectral::environmentValue(kVariable).value_or(kSystemName);
  if (name == kOff) {
    return nullptr;
  }
  const auto library = SystemLibrary::load(name);
  if (!library) {
    return nullptr;
  }
  auto functions = std::make_shared<OpenCl>();
  bool hasAll = true;
  const auto find = [&](auto& function, const char* symbol) {
    function = reinterpret_cast<std::remove_reference_t<decltype(function)>>(library->symbol(symbol));
    hasAll = hasAll && function != nullptr;
  };
  find(functions->queueInfo, "clGetCommandQueueInfo");
  find(functions->deviceInfo, "clGetDeviceInfo");
  find(functions->bufferInfo, "clGetMemObjectInfo");
  find(functions->buildInfo, "clGetProgramBuildInfo");
  find(functions->groupInfo, "clGetKernelWorkGroupInfo");
  find(functions->createProgram, "clCreateProgramWithSource");
  find(functions->buildProgram, "clBuildProgram");
  find(functions->createKernel, "clCreateKernel");
  find(functions->createBuffer, "clCreateBuffer");
  find(functions->setArgument, "clSetKernelArg");
  find(functions->enqueueKernel, "clEnqueueNDRangeKernel");
  find(functions->enqueueRead, "clEnqueueReadBuffer");
  find(functions->enqueueWrite, "clEnqueueWriteBuffer");
  find(functions->finish, "clFinish");
  find(functions->releaseBuffer, "clReleaseMemObject");
  find(functions->releaseKernel, "clReleaseKernel");
  find(functions->releaseProgram, "clReleaseProgram");
  return hasAll ? functions : nullptr;
}

}  // namespace metamer::ofx
