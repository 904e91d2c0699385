// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "device/device_renderer.h"
#include "host/property_set.h"

namespace metamer::ofx {

/// The devices that host and system have in common: OpenCL buffers, CUDA memory, Metal buffers.
class Devices {
 public:
  /// Loads the libraries of those that the host says it has.
  explicit Devices(const HostSuites& host);
  ~Devices();
  Devices(const Devices&) = delete;
  Devices& operator=(const Devices&) = delete;

  /// Tells an effect's descriptor of them.
  void describe(const PropertySet& descriptor) const;

  /// Renders where the render action's arguments say the images lie.
  /// @return empty, or what the user is to be told once
  /// @throws HostError
  std::string render(const HostSuites& host, const PropertySet& arguments, const RenderJob& job,
                     const std::function<bool()>& isAborted) const;

 private:
  struct Opened;
  std::vector<Opened> m_opened;
};

}  // namespace metamer::ofx
