// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "frame.h"

// What a host does that keeps its pictures on a device. The tests of it are built once for each kind.
namespace bare_host {

/// What a kind of device is called, and what it can.
struct DeviceWords {
  std::string kind;      ///< as Features::device
  std::string variable;  ///< of the environment, METAMER_OFX_...
  std::string library;   ///< the one with a ledger that the plug-in is to load
  bool hasDoubles;       ///< else log spaces and stages are read back
  /// Calls that the processor does without; those without which nothing can be brought back; the one that compiles.
  std::vector<const char*> needless;
  std::vector<const char*> needed;
  const char* compiling;
  int failure;  ///< what a failing call answers
};

class DeviceHost {
 public:
  using Handle = void*;

  virtual ~DeviceHost() = default;
  /// Empty, or why there is none: then nothing else is to be asked but words().
  const std::string& reason() const { return m_reason; }
  virtual const DeviceWords& words() const = 0;
  /// Two of them, in order.
  virtual Handle queue(int index = 0) const = 0;
  /// An event that nothing has signalled, and all that is put onto a queue later waits for it.
  virtual Handle hold(int queue = 0) const = 0;
  virtual void signal(Handle event) const = 0;

  /// A buffer, or a part of another from its `begin` on.
  virtual Handle buffer(std::size_t bytes, const void* data) const = 0;
  virtual Handle part(Handle buffer, std::size_t begin, std::size_t bytes) const = 0;
  /// What an image's data is, whose first pixel lies at a byte of the buffer.
  virtual Handle imageData(Handle buffer, std::size_t /*firstPixel*/) const { return buffer; }
  virtual void read(Handle buffer, std::size_t bytes, void* data, int queue = 0) const = 0;
  virtual void release(Handle buffer) const = 0;
  virtual void releasePart(Handle part) const { release(part); }
  /// At what bytes parts may begin; 0: there are none.
  virtual std::size_t partAlignment() const = 0;

 protected:
  std::string m_reason;
};

/// A device whose buffers are addresses, as CUDA's.
class AddressHost : public DeviceHost {
 public:
  Handle part(Handle buffer, std::size_t begin, std::size_t /*bytes*/) const final { return imageData(buffer, begin); }
  Handle imageData(Handle buffer, std::size_t firstPixel) const final {
    return static_cast<unsigned char*>(buffer) + firstPixel;
  }
  void releasePart(Handle /*part*/) const final {}
  std::size_t partAlignment() const final { return 4; }
};

/// Of the kind that the program is built for.
std::unique_ptr<DeviceHost> makeDeviceHost();

/// A frame's rows in a buffer, gaps and all, with guarded bytes after the last.
class DeviceFrame {
 public:
  /// @param begin  the rows lie in a part of a larger buffer that starts there
  DeviceFrame(const DeviceHost& host, const Frame& frame, std::size_t begin = 0);
  ~DeviceFrame();
  DeviceFrame(const DeviceFrame&) = delete;
  DeviceFrame& operator=(const DeviceFrame&) = delete;

  Image image(const std::string& premultiplication = kOfxImageUnPreMultiplied) const;
  /// The same memory with its rows in the other order.
  Image turnedImage() const;
  /// Brings the rows back into the frame; waits for the queue. False where a guarded byte has changed.
  bool bring(int queue = 0) const;

 private:
  const DeviceHost& m_host;
  const Frame& m_frame;
  std::size_t m_begin;
  std::size_t m_bytes = 0;
  unsigned char* m_low = nullptr;
  void* m_whole = nullptr;
  void* m_buffer = nullptr;
};

}  // namespace bare_host
