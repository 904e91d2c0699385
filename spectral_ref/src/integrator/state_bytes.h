// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>
#include <utility>
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
  StateReader(const ByteSource& source, std::string where) : m_source(source), m_where(std::move(where)) {}

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
  /// Into a vector that has either that size or none.
  template <typename T>
  void getAllOrNone(std::vector<T>& values, std::size_t size) {
    static_assert(std::is_trivially_copyable_v<T>);
    const auto stored = get<std::size_t>();
    if (stored != 0 && stored != size) {
      throw damaged();
    }
    values.resize(stored);
    if (stored > 0) {
      take(values.data(), stored * sizeof(T));
    }
  }
  void finish() const {
    if (m_place != m_source.size) {
      throw damaged();
    }
  }
  spectral::InputError damaged() const {
    return {m_where, "checkpoint", "", "is damaged or of another release; delete it and start again"};
  }
  const std::string& where() const { return m_where; }

 private:
  void take(void* data, std::size_t size) {
    if (size > m_source.size - m_place) {
      throw damaged();
    }
    m_source.take(data, size);
    m_place += size;
  }
  const ByteSource& m_source;
  std::string m_where;
  std::uint64_t m_place = 0;
};

}  // namespace metamer::spectral_ref
