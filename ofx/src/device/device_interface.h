// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>

#include "pixels/image.h"

namespace metamer::ofx {

struct WindowLaunch;

/// What a driver refused, in one line.
class DeviceError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;

  /// "CUDA: a kernel fails with 700".
  static DeviceError of(const char* interface, const char* call, long long status) {
    return DeviceError(std::string(interface) + ": " + call + " fails with " + std::to_string(status));
  }
};

/// An image in a host's buffer on a device.
struct DeviceImage {
  void* memory = nullptr;  ///< the interface's own: a handle, or an address on the device
  PixelView view;
  std::ptrdiff_t origin = 0;  ///< byte of the pixel (bounds.x1, bounds.y1) in the memory

  /// Of a view, at this memory's beginning: where row bytes are negative the topmost row comes first.
  static DeviceImage from(void* memory, const PixelView& view) {
    return {memory, view, view.rowBytes < 0 ? -rowsBelowTheLast(view) * view.rowBytes : 0};
  }

  bool isThere() const { return memory != nullptr && !isEmpty(view.bounds); }
  /// From the first byte of the rows to the last.
  std::size_t bytes() const {
    const std::ptrdiff_t step = view.rowBytes < 0 ? -view.rowBytes : view.rowBytes;
    const auto pixels = static_cast<std::size_t>(static_cast<std::ptrdiff_t>(view.bounds.x2) - view.bounds.x1);
    return static_cast<std::size_t>(rowsBelowTheLast(view) * step) + pixels * view.format.bytesPerPixel();
  }
  /// Byte of a pixel, or where it would be.
  std::ptrdiff_t byteOf(int x, int y) const {
    return origin + (static_cast<std::ptrdiff_t>(y) - view.bounds.y1) * view.rowBytes +
           (static_cast<std::ptrdiff_t>(x) - view.bounds.x1) * static_cast<std::ptrdiff_t>(view.format.bytesPerPixel());
  }

 private:
  static std::ptrdiff_t rowsBelowTheLast(const PixelView& view) {
    return static_cast<std::ptrdiff_t>(view.bounds.y2) - view.bounds.y1 - 1;
  }
};

/// A queue of the host's while one render uses it: all that a renderer asks of an interface to a device. What a driver
/// refuses is a DeviceError.
class DeviceQueue {
 public:
  virtual ~DeviceQueue() = default;

  /// Where an image lies, of a view whose data is what the host gives as an image's.
  /// @throws HostError kOfxStatErrImageFormat where the rows do not lie within their memory and the driver knows
  virtual DeviceImage image(const PixelView& view) = 0;
  /// Whether a kernel's writes could be read by another of its work items: memory shared, but not pixel on pixel.
  virtual bool interferes(const DeviceImage& input, const DeviceImage& output) const = 0;

  /// Where tables are copied to: one context, or device.
  virtual const void* place() const = 0;
  /// A copy of the bytes at that place, complete at once for every queue; freed when the last holder goes.
  virtual std::shared_ptr<void> upload(std::span<const std::byte> bytes) = 0;

  /// Puts the kernel onto the queue and returns. False where the device cannot run it.
  virtual bool launch(const WindowLaunch& launch) = 0;

  /// Whether all has run that was on the queue when this was first asked. Returns at once.
  virtual bool isIdle() = 0;
  /// From an image's memory, from a byte on. Waits for the queue.
  virtual void read(const DeviceImage& image, std::size_t first, std::span<unsigned char> bytes) = 0;
  /// To an image's memory. The bytes must stay until finish().
  virtual void write(const DeviceImage& image, std::size_t first, std::span<const unsigned char> bytes) = 0;
  virtual void finish() = 0;
};

/// A way to the host's devices: a library of the system's. Safe between threads.
class DeviceInterface {
 public:
  virtual ~DeviceInterface() = default;
  /// @param queue  as the host gives it
  virtual std::unique_ptr<DeviceQueue> open(void* queue) = 0;
};

}  // namespace metamer::ofx
