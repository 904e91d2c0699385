// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "drivers/devices.h"
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
  const Devices& devices() const { return m_devices; }
  const Effect& effect(std::size_t index) const { return *m_effects[index]; }

 private:
  HostSuites m_host;
  Devices m_devices;
  Catalogue m_catalogue;
  std::vector<std::unique_ptr<Effect>> m_effects;
};

/// Identifiers by index; known before anything is loaded.
inline constexpr int kEffectCount = 3;

}  // namespace metamer::ofx
