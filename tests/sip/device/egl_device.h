// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
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

  /// A table of three numbers a texel that a shader's sampler reads.
  struct Texture {
    std::string sampler;
    std::array<unsigned, 3> size{};  ///< depth 0: of two dimensions
    const float* values = nullptr;
    bool hasOneChannel = false;
    bool isHalf = false;     ///< kept as such by the driver
    bool isNearest = false;  ///< else between texels, linearly
  };

  /// Runs a compute shader's text over RGBA pixels. @throws std::runtime_error with the driver's words
  std::vector<float> run(const std::string& text, const DeviceTables& tables, std::span<const float> pixels,
                         std::span<const Texture> textures = {}) const;

 private:
  explicit EglDevice(std::string name) : m_name(std::move(name)) {}

  std::string m_name;
};

}  // namespace metamer::sip
