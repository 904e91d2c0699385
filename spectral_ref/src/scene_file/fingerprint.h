// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

namespace metamer::spectral_ref {

/// FNV-1a, 64 bits: tells files apart that were changed by accident, no more.
class Fingerprint {
 public:
  void add(const void* data, std::size_t size) {
    const auto* bytes = static_cast<const unsigned char*>(data);
    for (std::size_t i = 0; i < size; ++i) {
      m_value = (m_value ^ bytes[i]) * 0x100000001b3U;
    }
  }
  std::uint64_t value() const { return m_value; }

 private:
  std::uint64_t m_value = 0xcbf29ce484222325U;
};

}  // namespace metamer::spectral_ref
