// SPDX-License-Identifier: Apache-2.0
#include "effects/plugin.h"

#include "effects/led_stage.h"
#include "effects/skin.h"
#include "effects/spectral_transfer.h"
#include "host/device_properties.h"
#include "host/property_set.h"

namespace metamer::ofx {

namespace {

std::unique_ptr<OpenClRenderer> openClOf(const HostSuites& host) {
  const auto offered =
      PropertySet(host, host.hostProperties).findString(kOfxImageEffectPropOpenCLRenderSupported).value_or("false");
  return offered == "false" ? nullptr : OpenClRenderer::load();
}

}  // namespace

Plugin::Plugin(const OfxHost* host)
    : m_host(HostSuites::fetch(host)), m_openCl(openClOf(m_host)), m_catalogue(Catalogue::ofThisBundle()) {
  m_effects.push_back(makeSpectralTransfer(m_catalogue));
  m_effects.push_back(makeLedStage());
  m_effects.push_back(makeSkin(m_catalogue));
}

}  // namespace metamer::ofx
