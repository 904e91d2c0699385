// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "metamer/sip/device_kernels.h"

namespace metamer::sip {

/// OpenGL 4.3 without a window (EGL, Mesa's surfaceless platform), its library loaded when it is asked for; bound to
/// the thread that asked.
class EglDevice {
 public:
  /// Empty where there is no library or no such context; `reason` then says which.
  static std::optional<EglDevice> find(std::string& reason);

  const std::string& name() const { return m_name; }

  /// Runs a compute shader's text over RGBA pixels. @throws std::runtime_error with the driver's words
  std::vector<float> run(const std::string& text, const DeviceTables& tables, std::span<const float> pixels) const;

 private:
  explicit EglDevice(std::string name) : m_name(std::move(name)) {}

  std::string m_name;
};

}  // namespace metamer::sip
