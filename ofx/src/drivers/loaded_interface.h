// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <utility>

#include "device/device_interface.h"

namespace metamer::ofx {

/// A system's library with the programs that were built by it. Its queues are made of both and the host's queue.
template <typename Library, typename Programs, typename Queue>
class LoadedInterface final : public DeviceInterface {
 public:
  explicit LoadedInterface(std::shared_ptr<const Library> library)
      : m_library(library), m_programs(std::move(library)) {}

  std::unique_ptr<DeviceQueue> open(void* queue) override {
    return std::make_unique<Queue>(m_library, m_programs, queue);
  }

 private:
  std::shared_ptr<const Library> m_library;
  Programs m_programs;
};

}  // namespace metamer::ofx
