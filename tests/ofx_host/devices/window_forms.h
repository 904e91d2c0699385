// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstring>

/// A kernel's arguments, kept as a driver keeps them: copied when it is told.
class KeptArguments {
 public:
  void keep(std::size_t index, const void* value, std::size_t bytes) {
    std::memcpy(m_values[index].data(), value, bytes);
  }
  template <typename Value>
  Value get(std::size_t index) const {
    Value value;
    std::memcpy(&value, m_values[index].data(), sizeof value);
    return value;
  }

 private:
  std::array<std::array<unsigned char, 64>, 10> m_values{};
};
