// SPDX-License-Identifier: Apache-2.0
#include "effects/plugin.h"

#include "effects/led_stage.h"
#include "effects/skin.h"
#include "effects/spectral_transfer.h"

namespace metamer::ofx {

Plugin::Plugin(const OfxHost* host)
    : m_host(HostSuites::fetch(host)), m_devices(m_host), m_catalogue(Catalogue::ofThisBundle()) {
  m_effects.push_back(makeSpectralTransfer(m_catalogue));
  m_effects.push_back(makeLedStage());
  m_effects.push_back(makeSkin(m_catalogue));
}

}  // namespace metamer::ofx
