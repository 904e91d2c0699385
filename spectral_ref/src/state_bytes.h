// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstring>
#include <string>
#include <type_traits>
#include <vector>

#include "metamer/spectral/input_error.h"
#include "metamer/spectral_ref/checkpoint.h"

namespace metamer::spectral_ref {

/// Hands on plain values as bytes.
class StateWriter {
 public:
  explicit StateWriter(const ByteSink& sink) : m_sink(sink) {}

  template <typename T>
  void put(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    m_sink(&value, sizeof value);
  }
  template <typename T>
  void putAll(const std::vector<T>& values) {
    static_assert(std::is_trivially_copyable_v<T>);
    put(values.size());
    m_sink(values.data(), values.size() * sizeof(T));
  }

 private:
  const ByteSink& m_sink;
};

/// Takes them out again.
class StateReader {
 public:
  StateReader(const std::vector<unsigned char>& bytes, std::string where) : m_bytes(bytes), m_where(std::move(where)) {}

  template <typename T>
  T get() {
    static_assert(std::is_trivially_copyable_v<T>);
    T value;
    take(&value, sizeof value);
    return value;
  }
  /// Into a vector that has the right size already.
  template <typename T>
  void getAll(std::vector<T>& values) {
    static_assert(std::is_trivially_copyable_v<T>);
    if (get<std::size_t>() != values.size()) {
      throw damaged();
    }
    take(values.data(), values.size() * sizeof(T));
  }
  void finish() const {
    if (m_place != m_bytes.size()) {
      throw damaged();
    }
  }
  spectral::InputError damaged() const {
    return {m_where, "checkpoint", "", "is damaged or of another release; delete it and start again"};
  }
  const std::string& where() const { return m_where; }

 private:
  void take(void* data, std::size_t size) {
    if (size > m_bytes.size() - m_place) {
      throw damaged();
    }
    if (size > 0) {
      std::memcpy(data, m_bytes.data() + m_place, size);
    }
    m_place += size;
  }
  const std::vector<unsigned char>& m_bytes;
  std::string m_where;
  std::size_t m_place = 0;
};

}  // namespace metamer::spectral_ref
