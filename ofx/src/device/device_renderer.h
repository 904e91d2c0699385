// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "device/device_interface.h"
#include "pixels/render.h"

namespace metamer::ofx {

/// Renders where the host keeps its images on a device. Safe between threads.
class DeviceRenderer {
 public:
  explicit DeviceRenderer(std::unique_ptr<DeviceInterface> interface) : m_interface(std::move(interface)) {}

  /// Puts a render onto the host's queue and returns; the images' data are its memory there. Pixels get the bits that
  /// render() gives them. What no kernel does is done by the processor, between reading and writing on the queue: then
  /// it waits.
  /// @return empty, or in a line what the driver refused, so that the processor had to
  /// @throws HostError kOfxStatGPURenderFailed where not even that can be done, and hosts are to try again without the
  ///         device; kOfxStatErrImageFormat for an image that does not lie within its memory
  std::string render(const HostSuites& host, void* queue, const RenderJob& job,
                     const std::function<bool()>& isAborted) const;

 private:
  std::unique_ptr<DeviceInterface> m_interface;
};

}  // namespace metamer::ofx
