// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>

#include "drivers/devices.h"
#include "effects/effect.h"
#include "host/host.h"
#include "host/message.h"
#include "host/parameter_values.h"
#include "pixels/image.h"
#include "pixels/render.h"

namespace metamer::ofx {

/// Names of the clips that every effect has.
inline constexpr const char* kMaskClipName = "Mask";

/// One use of an effect in a project. Its actions are safe to run at once from several threads.
class Instance {
 public:
  /// @param devices  render where the host keeps its images
  /// @throws HostError
  Instance(const HostSuites& host, const Effect& effect, OfxImageEffectHandle handle, const Devices& devices);

  void instanceChanged(const PropertySet& arguments);
  void render(const PropertySet& arguments);
  /// True where the action's answer is the source as it is.
  bool isIdentity(const PropertySet& arguments);
  void clipPreferences(const PropertySet& answers) const;

  MessageBoard& messages() { return m_messages; }

 private:
  /// Renders where the host keeps its images. @throws HostError
  void renderJob(const PropertySet& arguments, const RenderJob& job);
  /// Nothing where the parameters have no meaning: the message then says why.
  std::shared_ptr<const PixelTransform> transformOrMessage(double time);
  std::optional<std::string> hostSpace() const;
  bool isConnected(OfxImageClipHandle clip) const;
  OfxImageClipHandle clip(const char* name) const;
  std::string clipString(OfxImageClipHandle clip, const char* property) const;

  const HostSuites& m_host;
  const Effect& m_effect;
  OfxImageEffectHandle m_handle;
  const Devices& m_devices;
  ParameterValues m_values;
  MessageBoard m_messages;
  OfxImageClipHandle m_source;
  OfxImageClipHandle m_mask;  ///< null where the host has none
  OfxImageClipHandle m_output;
};

}  // namespace metamer::ofx
