// SPDX-License-Identifier: Apache-2.0
#include "sip/device/opencl_device.h"

#include <dlfcn.h>

#include <array>
#include <cstdint>
#include <stdexcept>

namespace metamer::sip {
namespace {

// Of the OpenCL 1.2 specification, as far as it is used here: its headers are a package of their own.
using Handle = void*;
using Status = std::int32_t;
using Flags = std::uint64_t;
constexpr Flags kReadWrite = 1U << 0U;
constexpr Flags kReadOnly = 1U << 2U;
constexpr Flags kCopiesHost = 1U << 5U;
constexpr Flags kAnyKind = 0xFFFFFFFF;
constexpr std::uint32_t kDeviceName = 0x102B;
constexpr std::uint32_t kBuildLog = 0x1183;
constexpr const char* kBuildOptions = "-cl-std=CL1.2 -cl-fp32-correctly-rounded-divide-sqrt";

void require(Status status, const std::string& what) {
  if (status != 0) {
    throw std::runtime_error("OpenCL: " + what + " gives " + std::to_string(status));
  }
}

}  // namespace

struct OpenClDevice::Driver {
  Status (*getPlatforms)(std::uint32_t, Handle*, std::uint32_t*) = nullptr;
  Status (*getDevices)(Handle, Flags, std::uint32_t, Handle*, std::uint32_t*) = nullptr;
  Status (*getDeviceInfo)(Handle, std::uint32_t, std::size_t, void*, std::size_t*) = nullptr;
  Handle (*createContext)(const std::intptr_t*, std::uint32_t, const Handle*, void*, void*, Status*) = nullptr;
  Handle (*createQueue)(Handle, Handle, Flags, Status*) = nullptr;
  Handle (*createProgram)(Handle, std::uint32_t, const char**, const std::size_t*, Status*) = nullptr;
  Status (*buildProgram)(Handle, std::uint32_t, const Handle*, const char*, void*, void*) = nullptr;
  Status (*getBuildInfo)(Handle, Handle, std::uint32_t, std::size_t, void*, std::size_t*) = nullptr;
  Handle (*createKernel)(Handle, const char*, Status*) = nullptr;
  Handle (*createBuffer)(Handle, Flags, std::size_t, const void*, Status*) = nullptr;
  Status (*setArgument)(Handle, std::uint32_t, std::size_t, const void*) = nullptr;
  Status (*enqueue)(Handle, Handle, std::uint32_t, const std::size_t*, const std::size_t*, const std::size_t*,
                    std::uint32_t, const Handle*, Handle*) = nullptr;
  Status (*read)(Handle, Handle, std::uint32_t, std::size_t, std::size_t, void*, std::uint32_t, const Handle*,
                 Handle*) = nullptr;
  Status (*releaseBuffer)(Handle) = nullptr;
  Status (*releaseKernel)(Handle) = nullptr;
  Status (*releaseProgram)(Handle) = nullptr;

  Handle device = nullptr;
  Handle context = nullptr;
  Handle queue = nullptr;

  /// @throws std::runtime_error where a function is missing
  explicit Driver(void* library) {
    const auto find = [library](auto& function, const char* name) {
      void* const symbol = dlsym(library, name);
      if (symbol == nullptr) {
        throw std::runtime_error(std::string("OpenCL: no ") + name);
      }
      function = reinterpret_cast<std::remove_reference_t<decltype(function)>>(symbol);
    };
    find(getPlatforms, "clGetPlatformIDs");
    find(getDevices, "clGetDeviceIDs");
    find(getDeviceInfo, "clGetDeviceInfo");
    find(createContext, "clCreateContext");
    find(createQueue, "clCreateCommandQueue");
    find(createProgram, "clCreateProgramWithSource");
    find(buildProgram, "clBuildProgram");
    find(getBuildInfo, "clGetProgramBuildInfo");
    find(createKernel, "clCreateKernel");
    find(createBuffer, "clCreateBuffer");
    find(setArgument, "clSetKernelArg");
    find(enqueue, "clEnqueueNDRangeKernel");
    find(read, "clEnqueueReadBuffer");
    find(releaseBuffer, "clReleaseMemObject");
    find(releaseKernel, "clReleaseKernel");
    find(releaseProgram, "clReleaseProgram");
  }

  /// @throws std::runtime_error with the compiler's words
  Handle program(const std::string& text) const {
    Status status = 0;
    const char* source = text.c_str();
    Handle const program = createProgram(context, 1, &source, nullptr, &status);
    require(status, "a program");
    if (buildProgram(program, 1, &device, kBuildOptions, nullptr, nullptr) != 0) {
      std::string log(1U << 16U, '\0');
      std::size_t size = 0;
      getBuildInfo(program, device, kBuildLog, log.size(), log.data(), &size);
      throw std::runtime_error("OpenCL: " + log.substr(0, size));
    }
    return program;
  }
};

std::optional<OpenClDevice> OpenClDevice::find(std::string& reason) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  reason = "a driver's own compiler does not run under a sanitizer";
  return std::nullopt;
#endif
  // Never closed: drivers leave threads and handlers behind.
  void* const library = dlopen("libOpenCL.so.1", RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) {
    reason = "no libOpenCL.so.1";
    return std::nullopt;
  }
  const auto driver = std::make_shared<Driver>(library);
  Handle platform = nullptr;
  std::uint32_t count = 0;
  if (driver->getPlatforms(1, &platform, &count) != 0 || count == 0) {
    reason = "no OpenCL driver";
    return std::nullopt;
  }
  if (driver->getDevices(platform, kAnyKind, 1, &driver->device, &count) != 0 || count == 0) {
    reason = "no OpenCL device";
    return std::nullopt;
  }
  std::array<char, 256> name{};
  driver->getDeviceInfo(driver->device, kDeviceName, name.size() - 1, name.data(), nullptr);
  Status status = 0;
  driver->context = driver->createContext(nullptr, 1, &driver->device, nullptr, nullptr, &status);
  require(status, "a context");
  driver->queue = driver->createQueue(driver->context, driver->device, 0, &status);
  require(status, "a queue");
  try {
    driver->releaseProgram(driver->program("__kernel void nothing(void) {}"));
  } catch (const std::runtime_error& error) {
    reason = "the driver compiles nothing here: " + std::string(error.what());
    return std::nullopt;
  }
  return OpenClDevice(driver, name.data());
}

std::vector<float> OpenClDevice::run(const std::string& text, const std::string& entry, const DeviceTables& tables,
                                     std::span<const float> pixels) const {
  const Driver& driver = *m_driver;
  Status status = 0;
  Handle const program = driver.program(text);
  Handle const kernel = driver.createKernel(program, entry.c_str(), &status);
  require(status, entry);
  const auto buffer = [&](Flags access, std::size_t bytes, const void* data) {
    static constexpr std::array<std::byte, 16> kNothing{};  // no buffer is empty
    Handle const made = driver.createBuffer(driver.context, access | kCopiesHost, bytes != 0 ? bytes : kNothing.size(),
                                            bytes != 0 ? data : kNothing.data(), &status);
    require(status, "a buffer");
    return made;
  };
  std::vector<float> result(pixels.size());
  const std::array<Handle, 4> buffers = {
      buffer(kReadOnly, pixels.size_bytes(), pixels.data()), buffer(kReadWrite, pixels.size_bytes(), pixels.data()),
      buffer(kReadOnly, sizeof(tables.nodes[0]) * tables.nodes.size(), tables.nodes.data()),
      buffer(kReadOnly, sizeof(std::uint32_t) * tables.cells.size(), tables.cells.data())};
  const auto pixelCount = static_cast<std::uint32_t>(pixels.size() / 4);
  require(driver.setArgument(kernel, 0, sizeof(Handle), &buffers[0]), "argument 0");
  require(driver.setArgument(kernel, 1, sizeof(Handle), &buffers[1]), "argument 1");
  require(driver.setArgument(kernel, 2, sizeof pixelCount, &pixelCount), "argument 2");
  require(driver.setArgument(kernel, 3, sizeof(Handle), &buffers[2]), "argument 3");
  require(driver.setArgument(kernel, 4, sizeof(Handle), &buffers[3]), "argument 4");
  constexpr std::size_t kGroup = 64;
  const std::size_t global = (pixelCount + kGroup - 1) / kGroup * kGroup;
  require(driver.enqueue(driver.queue, kernel, 1, nullptr, &global, &kGroup, 0, nullptr, nullptr), "the kernel");
  require(driver.read(driver.queue, buffers[1], 1, 0, pixels.size_bytes(), result.data(), 0, nullptr, nullptr),
          "the result");
  for (Handle const each : buffers) {
    driver.releaseBuffer(each);
  }
  driver.releaseKernel(kernel);
  driver.releaseProgram(program);
  return result;
}

}  // namespace metamer::sip
