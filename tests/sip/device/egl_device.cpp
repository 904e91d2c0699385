// SPDX-License-Identifier: Apache-2.0
#include "sip/device/egl_device.h"

#include <dlfcn.h>

#include <array>
#include <cstdint>
#include <cstdlib>
#include <stdexcept>

namespace metamer::sip {
namespace {

// Of EGL 1.5 and OpenGL 4.3, as far as they are used here: their headers are packages of their own.
using Handle = void*;
using Id = std::uint32_t;
constexpr Id kSurfacelessMesa = 0x31DD;
constexpr Id kOpenGlApi = 0x30A2;
constexpr std::array kVersion43 = {0x3098, 4, 0x30FB, 3, 0x3038};
constexpr Id kComputeShader = 0x91B9;
constexpr Id kCompileStatus = 0x8B81;
constexpr Id kLinkStatus = 0x8B82;
constexpr Id kStorageBuffer = 0x90D2;
constexpr Id kDynamicCopy = 0x88EA;
constexpr Id kAllBarriers = 0xFFFFFFFF;
constexpr Id kRenderer = 0x1F01;
constexpr Id kTexture2D = 0x0DE1;
constexpr Id kTexture3D = 0x806F;
constexpr Id kTexture0 = 0x84C0;
constexpr Id kMinFilter = 0x2801;
constexpr Id kMagFilter = 0x2800;
constexpr Id kWrapS = 0x2802;
constexpr Id kWrapT = 0x2803;
constexpr Id kWrapR = 0x8072;
constexpr Id kUnpackAlignment = 0x0CF5;
constexpr Id kRed = 0x1903;
constexpr Id kRgb = 0x1907;
constexpr Id kFloat = 0x1406;
constexpr int kNearest = 0x2600;
constexpr int kLinear = 0x2601;
constexpr int kClampToEdge = 0x812F;
constexpr int kRed16 = 0x822D;
constexpr int kRed32 = 0x822E;
constexpr int kRgb16 = 0x881B;
constexpr int kRgb32 = 0x8815;

Handle (*eglProcedure)(const char*) = nullptr;

/// A function of OpenGL's. @throws std::runtime_error where there is none
template <typename Function>
Function* gl(const char* name) {
  Handle const found = eglProcedure(name);
  if (found == nullptr) {
    throw std::runtime_error(std::string("OpenGL: no ") + name);
  }
  return reinterpret_cast<Function*>(found);
}

Id programOf(const std::string& text) {
  const Id shader = gl<Id(Id)>("glCreateShader")(kComputeShader);
  const char* source = text.c_str();
  gl<void(Id, int, const char**, const int*)>("glShaderSource")(shader, 1, &source, nullptr);
  gl<void(Id)>("glCompileShader")(shader);
  std::array<char, 4096> words{};
  int status = 0;
  gl<void(Id, Id, int*)>("glGetShaderiv")(shader, kCompileStatus, &status);
  if (status == 0) {
    gl<void(Id, int, int*, char*)>("glGetShaderInfoLog")(shader, static_cast<int>(words.size()), nullptr, words.data());
    throw std::runtime_error(std::string("OpenGL: ") + words.data());
  }
  const Id program = gl<Id()>("glCreateProgram")();
  gl<void(Id, Id)>("glAttachShader")(program, shader);
  gl<void(Id)>("glLinkProgram")(program);
  gl<void(Id, Id, int*)>("glGetProgramiv")(program, kLinkStatus, &status);
  gl<void(Id)>("glDeleteShader")(shader);
  if (status == 0) {
    gl<void(Id, int, int*, char*)>("glGetProgramInfoLog")(program, static_cast<int>(words.size()), nullptr,
                                                          words.data());
    throw std::runtime_error(std::string("OpenGL: ") + words.data());
  }
  return program;
}

/// Binds a texture to a unit and its sampler. @return its name
Id bind(const EglDevice::Texture& texture, Id unit, Id program) {
  const bool isCube = texture.size[2] != 0;
  const Id target = isCube ? kTexture3D : kTexture2D;
  const Id format = texture.hasOneChannel ? kRed : kRgb;
  const int kept = texture.hasOneChannel ? (texture.isHalf ? kRed16 : kRed32) : (texture.isHalf ? kRgb16 : kRgb32);
  Id name = 0;
  gl<void(int, Id*)>("glGenTextures")(1, &name);
  gl<void(Id)>("glActiveTexture")(kTexture0 + unit);
  gl<void(Id, Id)>("glBindTexture")(target, name);
  const auto set = [&](Id what, int value) { gl<void(Id, Id, int)>("glTexParameteri")(target, what, value); };
  set(kMinFilter, texture.isNearest ? kNearest : kLinear);
  set(kMagFilter, texture.isNearest ? kNearest : kLinear);
  for (const Id wrap : {kWrapS, kWrapT, kWrapR}) {
    set(wrap, kClampToEdge);
  }
  gl<void(Id, int)>("glPixelStorei")(kUnpackAlignment, 4);
  const auto side = [&](std::size_t k) { return static_cast<int>(texture.size[k]); };
  if (isCube) {
    gl<void(Id, int, int, int, int, int, int, Id, Id, const void*)>("glTexImage3D")(
        target, 0, kept, side(0), side(1), side(2), 0, format, kFloat, texture.values);
  } else {
    gl<void(Id, int, int, int, int, int, Id, Id, const void*)>("glTexImage2D")(target, 0, kept, side(0), side(1), 0,
                                                                               format, kFloat, texture.values);
  }
  const int place = gl<int(Id, const char*)>("glGetUniformLocation")(program, texture.sampler.c_str());
  gl<void(int, int)>("glUniform1i")(place, static_cast<int>(unit));
  return name;
}

}  // namespace

std::optional<EglDevice> EglDevice::find(std::string& reason) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  reason = "a driver's own compiler does not run under a sanitizer";
  return std::nullopt;
#endif
  // Never closed: drivers leave threads and handlers behind.
  void* const library = dlopen("libEGL.so.1", RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) {
    reason = "no libEGL.so.1";
    return std::nullopt;
  }
  const auto egl = [library]<typename Function>(Function*& function, const char* name) {
    function = reinterpret_cast<Function*>(dlsym(library, name));
    return function != nullptr;
  };
  Handle (*getDisplay)(Id, Handle, const std::intptr_t*) = nullptr;
  Id (*initialise)(Handle, int*, int*) = nullptr;
  Id (*bindApi)(Id) = nullptr;
  Handle (*createContext)(Handle, Handle, Handle, const int*) = nullptr;
  Id (*makeCurrent)(Handle, Handle, Handle, Handle) = nullptr;
  if (!egl(eglProcedure, "eglGetProcAddress") || !egl(getDisplay, "eglGetPlatformDisplay") ||
      !egl(initialise, "eglInitialize") || !egl(bindApi, "eglBindAPI") || !egl(createContext, "eglCreateContext") ||
      !egl(makeCurrent, "eglMakeCurrent")) {
    reason = "an EGL older than 1.5";
    return std::nullopt;
  }
  // The processor's own driver, whatever else there is.
  setenv("LIBGL_ALWAYS_SOFTWARE", "1", 1);
  Handle const display = getDisplay(kSurfacelessMesa, nullptr, nullptr);
  if (display == nullptr || initialise(display, nullptr, nullptr) == 0 || bindApi(kOpenGlApi) == 0) {
    reason = "no EGL display without a window";
    return std::nullopt;
  }
  Handle const context = createContext(display, nullptr, nullptr, kVersion43.data());
  if (context == nullptr || makeCurrent(display, nullptr, nullptr, context) == 0) {
    reason = "no OpenGL 4.3";
    return std::nullopt;
  }
  return EglDevice(reinterpret_cast<const char*>(gl<const unsigned char*(Id)>("glGetString")(kRenderer)));
}

std::vector<float> EglDevice::run(const std::string& text, const DeviceTables& tables, std::span<const float> pixels,
                                  std::span<const Texture> textures) const {
  const Id program = programOf(text);
  std::array<Id, 4> buffers{};
  gl<void(int, Id*)>("glGenBuffers")(4, buffers.data());
  const auto fill = [&](Id binding, std::size_t bytes, const void* data) {
    gl<void(Id, Id, Id)>("glBindBufferBase")(kStorageBuffer, binding, buffers[binding]);
    gl<void(Id, std::intptr_t, const void*, Id)>("glBufferData")(kStorageBuffer, static_cast<std::intptr_t>(bytes),
                                                                 data, kDynamicCopy);
  };
  fill(0, pixels.size_bytes(), pixels.data());
  fill(1, pixels.size_bytes(), pixels.data());
  fill(2, sizeof(std::array<float, 4>) * tables.nodes.size(), tables.nodes.data());
  fill(3, sizeof(std::uint32_t) * tables.cells.size(), tables.cells.data());
  const auto pixelCount = static_cast<Id>(pixels.size() / 4);
  gl<void(Id)>("glUseProgram")(program);
  gl<void(int, Id)>("glUniform1ui")(0, pixelCount);
  std::vector<Id> bound;
  for (const Texture& texture : textures) {
    bound.push_back(bind(texture, static_cast<Id>(bound.size()), program));
  }
  gl<void(Id, Id, Id)>("glDispatchCompute")((pixelCount + 63) / 64, 1, 1);
  gl<void(Id)>("glMemoryBarrier")(kAllBarriers);
  std::vector<float> result(pixels.size());
  gl<void(Id, Id)>("glBindBuffer")(kStorageBuffer, buffers[1]);
  gl<void(Id, std::intptr_t, std::intptr_t, void*)>("glGetBufferSubData")(
      kStorageBuffer, 0, static_cast<std::intptr_t>(pixels.size_bytes()), result.data());
  gl<void(int, const Id*)>("glDeleteBuffers")(4, buffers.data());
  gl<void(int, const Id*)>("glDeleteTextures")(static_cast<int>(bound.size()), bound.data());
  gl<void(Id)>("glDeleteProgram")(program);
  return result;
}

}  // namespace metamer::sip
