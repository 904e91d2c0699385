// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "metamer/sip/device_kernels.h"

namespace metamer::sip {

/// The first device of the first OpenCL driver, its library loaded when it is asked for.
class OpenClDevice {
 public:
  /// Empty where there is no library, driver or device; `reason` then says which.
  static std::optional<OpenClDevice> find(std::string& reason);

  const std::string& name() const { return m_name; }

  /// Runs a text's entry over RGBA pixels. @throws std::runtime_error with the driver's words
  std::vector<float> run(const std::string& text, const std::string& entry, const DeviceTables& tables,
                         std::span<const float> pixels) const;

 private:
  struct Driver;
  OpenClDevice(std::shared_ptr<const Driver> driver, std::string name)
      : m_driver(std::move(driver)), m_name(std::move(name)) {}

  std::shared_ptr<const Driver> m_driver;
  std::string m_name;
};

}  // namespace metamer::sip
