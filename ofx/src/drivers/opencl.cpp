// SPDX-License-Identifier: Apache-2.0
#include "drivers/opencl.h"

#include "drivers/system_library.h"

namespace metamer::ofx {
namespace {

#if defined(_WIN32)
constexpr const char* kSystemName = "OpenCL.dll";
#elif defined(__APPLE__)
constexpr const char* kSystemName = "/System/Library/Frameworks/OpenCL.framework/OpenCL";
#else
constexpr const char* kSystemName = "libOpenCL.so.1";
#endif

}  // namespace

std::shared_ptr<const OpenCl> OpenCl::load(const char* variable) {
  const auto library = SystemLibrary::loadOr(variable, kSystemName);
  if (!library) {
    return nullptr;
  }
  auto functions = std::make_shared<OpenCl>();
  bool hasAll = true;
  const auto find = [&](auto& function, const char* symbol) { hasAll = library->find(function, symbol) && hasAll; };
  find(functions->queueInfo, "clGetCommandQueueInfo");
  find(functions->deviceInfo, "clGetDeviceInfo");
  find(functions->bufferInfo, "clGetMemObjectInfo");
  find(functions->buildInfo, "clGetProgramBuildInfo");
  find(functions->groupInfo, "clGetKernelWorkGroupInfo");
  find(functions->eventInfo, "clGetEventInfo");
  find(functions->createProgram, "clCreateProgramWithSource");
  find(functions->buildProgram, "clBuildProgram");
  find(functions->createKernel, "clCreateKernel");
  find(functions->createBuffer, "clCreateBuffer");
  find(functions->setArgument, "clSetKernelArg");
  find(functions->enqueueKernel, "clEnqueueNDRangeKernel");
  find(functions->enqueueRead, "clEnqueueReadBuffer");
  find(functions->enqueueWrite, "clEnqueueWriteBuffer");
  find(functions->enqueueMarker, "clEnqueueMarker");
  find(functions->flush, "clFlush");
  find(functions->finish, "clFinish");
  find(functions->releaseBuffer, "clReleaseMemObject");
  find(functions->releaseEvent, "clReleaseEvent");
  find(functions->releaseKernel, "clReleaseKernel");
  find(functions->releaseProgram, "clReleaseProgram");
  return hasAll ? functions : nullptr;
}

}  // namespace metamer::ofx
