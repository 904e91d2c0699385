// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>

#include "device/device_interface.h"
#include "device/window_text.h"
#include "pixels/device_form.h"
#include "pixels/render.h"

namespace metamer::ofx {

/// An argument as a driver takes it.
struct KernelArgument {
  const void* value;  ///< of a memory: points to the interface's handle or address
  std::size_t bytes;
  bool isMemory;
};

/// A kernel over a window with all that it is given. The arguments point into it.
struct WindowLaunch {
  const char* kernel = nullptr;
  std::array<WindowImage, 3> images{};  ///< source, mask, output
  std::array<void*, 3> pixels{};        ///< their memory; what is not there is stood for by the output's
  Window window;
  void* nodes = nullptr;
  void* cells = nullptr;
  void* curve = nullptr;  ///< null: the kernel has none

  static constexpr std::size_t kMostArguments = 10;
  /// In the order of WindowArgument. @return their number
  std::size_t arguments(std::array<KernelArgument, kMostArguments>& to) const;
};

/// The kernel of a form.
const char* kernelOf(const DeviceForm& form);

/// What of a job is rendered, within an area of the output.
Window windowOf(const RenderJob& job, const OfxRectI& area);

/// As the kernels are told. Empty for what they do not read or write: whole numbers, channels off their alignment.
std::optional<WindowImage> windowImage(const DeviceImage& image);

}  // namespace metamer::ofx
