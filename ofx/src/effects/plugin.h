// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "device/opencl_renderer.h"
#include "effects/catalogue.h"
#include "effects/effect.h"
#include "host/host.h"

namespace metamer::ofx {

/// What lives from the first load action to the last unload action: the host's suites, the tables, the effects, and the
/// way to the host's devices.
class Plugin {
 public:
  /// @throws HostError where the host lacks what every effect needs
  explicit Plugin(const OfxHost* host);

  const HostSuites& host() const { return m_host; }
  /// Null where the host has no OpenCL buffers, or the system no OpenCL.
  OpenClRenderer* openCl() const { return m_openCl.get(); }
  const Effect& effect(std::size_t index) const { return *m_effects[index]; }

 private:
  HostSuites m_host;
  std::unique_ptr<OpenClRenderer> m_openCl;
  Catalogue m_catalogue;
  std::vector<std::unique_ptr<Effect>> m_effects;
};

/// Identifiers by index; known before anything is loaded.
inline constexpr int kEffectCount = 3;

}  // namespace metamer::ofx
