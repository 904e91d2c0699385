// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "device_host.h"

namespace bare_host {

/// A host with memory on a CUDA card, in the primary context, as hosts have it. Its driver is the one that the plug-in
/// loads: the system's, or what METAMER_OFX_CUDA names.
class CudaCardHost final : public AddressHost {
 public:
  /// @throws std::runtime_error in a line where there is no driver or no card
  CudaCardHost();
  ~CudaCardHost() override;
  CudaCardHost(const CudaCardHost&) = delete;
  CudaCardHost& operator=(const CudaCardHost&) = delete;

  const std::string& cardName() const { return m_name; }
  const DeviceWords& words() const override { return m_words; }
  Handle queue(int index) const override { return m_streams[index]; }
  Handle buffer(std::size_t bytes, const void* data) const override;
  void read(Handle buffer, std::size_t bytes, void* data, int queue) const override;
  void release(Handle buffer) const override;
  /// A card's queue cannot be held without a kernel of one's own. @throws std::logic_error
  Handle hold(int queue) const override;
  void signal(Handle event) const override;

  /// From one buffer into another on the card, not waited for.
  void copy(Handle to, Handle from, std::size_t bytes, int queue = 0) const;
  void wait(int queue = 0) const;

 private:
  struct Driver;
  const DeviceWords m_words = {"Cuda", "METAMER_OFX_CUDA", "", true, {}, {}, "", 0};
  std::unique_ptr<const Driver> m_driver;
  std::string m_name;
  std::int32_t m_card = 0;
  Handle m_streams[2] = {};
};

}  // namespace bare_host
