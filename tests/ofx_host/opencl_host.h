// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

#include "frame.h"

// What a host does that keeps its pictures in OpenCL buffers.
namespace bare_host {

/// A device of the first OpenCL driver; null members: there is none, and `reason` says why.
class OpenClHost {
 public:
  using Handle = void*;

  OpenClHost();
  ~OpenClHost();
  OpenClHost(const OpenClHost&) = delete;
  OpenClHost& operator=(const OpenClHost&) = delete;

  const std::string& reason() const { return m_reason; }
  Handle context() const { return m_context; }
  /// Two of them, in order.
  Handle queue(int index = 0) const { return m_queues[index]; }
  void finish(int queue = 0) const;

  /// An event that nothing has signalled, and all that is put onto a queue later waits for it.
  Handle hold(int queue = 0) const;
  void signal(Handle event) const;

  /// A buffer, or a part of another from its `begin` on.
  Handle buffer(std::size_t bytes, const void* data) const;
  Handle part(Handle buffer, std::size_t begin, std::size_t bytes) const;
  void read(Handle buffer, std::size_t bytes, void* data, int queue = 0) const;
  void release(Handle buffer) const;
  /// At what bytes parts may begin.
  std::size_t partAlignment() const;

 private:
  struct Driver;
  std::unique_ptr<const Driver> m_driver;
  std::string m_reason;
  Handle m_device = nullptr;
  Handle m_context = nullptr;
  Handle m_queues[2] = {};
};

/// A frame's rows in a buffer, gaps and all, with guarded bytes after the last.
class OpenClFrame {
 public:
  /// @param begin  the rows lie in a part of a larger buffer that starts there
  OpenClFrame(const OpenClHost& host, const Frame& frame, std::size_t begin = 0);
  ~OpenClFrame();
  OpenClFrame(const OpenClFrame&) = delete;
  OpenClFrame& operator=(const OpenClFrame&) = delete;

  Image image(const std::string& premultiplication = kOfxImageUnPreMultiplied) const;
  /// Brings the rows back into the frame; waits for the queue. False where a guarded byte has changed.
  bool bring(int queue = 0) const;

 private:
  const OpenClHost& m_host;
  const Frame& m_frame;
  std::size_t m_begin;
  std::size_t m_bytes = 0;
  unsigned char* m_low = nullptr;
  void* m_whole = nullptr;
  void* m_buffer = nullptr;
};

}  // namespace bare_host
