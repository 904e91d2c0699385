// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "device/opencl_programs.h"
#include "pixels/render.h"

namespace metamer::ofx {

/// Renders where the host keeps its images in OpenCL buffers. Safe between threads.
class OpenClRenderer {
 public:
  /// Null where OpenCl::load() is: hosts are then not told that the effects render on devices.
  static std::unique_ptr<OpenClRenderer> load();

  /// Puts a render onto the host's queue and returns; the images' data are its buffers. Pixels get the bits that
  /// render() gives them. What no kernel does is done by the processor, between reading and writing on the queue: then
  /// it waits.
  /// @return empty, or in a line what the driver refused, so that the processor had to
  /// @throws HostError kOfxStatGPURenderFailed where not even that can be done, and hosts are to try again without the
  ///         device; kOfxStatErrImageFormat for an image that does not lie within its buffer
  std::string render(const HostSuites& host, void* queue, const RenderJob& job, const std::function<bool()>& isAborted);

 private:
  explicit OpenClRenderer(std::shared_ptr<const OpenCl> library) : m_library(library), m_programs(std::move(library)) {}

  /// False where no kernel does it. @throws OpenClError
  bool enqueue(OpenCl::Handle queue, const RenderJob& job);

  std::shared_ptr<const OpenCl> m_library;
  OpenClPrograms m_programs;
};

}  // namespace metamer::ofx
