// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstring>
#include <string>
#include <string_view>

#include "metamer/spectral/input_error.h"

namespace metamer::lutgen {

static_assert(std::endian::native == std::endian::little, "EXR files are little-endian, and so is what reads them");

/// Numbers and texts one after another, never beyond the end.
class ExrReader {
 public:
  ExrReader(std::string_view bytes, const std::string& file, std::size_t position = 0)
      : m_bytes(bytes), m_file(&file), m_position(position) {}

  template <typename Number>
  Number number() {
    Number value;
    std::memcpy(&value, take(sizeof(Number)).data(), sizeof(Number));
    return value;
  }

  std::string_view take(std::uint64_t size) {
    if (m_position > m_bytes.size() || size > m_bytes.size() - m_position) {
      throw spectral::InputError(*m_file, "bytes", std::to_string(m_bytes.size()),
                                 "end in the middle of the picture: it is cut short or damaged; write it again");
    }
    const std::string_view part = m_bytes.substr(m_position, size);
    m_position += size;
    return part;
  }

  /// Up to a zero byte, at most 255 of them.
  std::string text() {
    const std::string_view rest = m_bytes.substr(std::min(m_position, m_bytes.size()));
    const std::size_t end = rest.substr(0, 256).find('\0');
    if (end == std::string_view::npos) {
      throw spectral::InputError(*m_file, "header", "", "is damaged: a name does not end; write the picture again");
    }
    m_position += end + 1;
    return std::string(rest.substr(0, end));
  }

  std::size_t position() const { return m_position; }
  std::size_t left() const { return m_bytes.size() - m_position; }

 private:
  std::string_view m_bytes;
  const std::string* m_file;
  std::size_t m_position;
};

/// Appends a number's bytes.
template <typename Number>
void putNumber(std::string& bytes, Number value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof(value));
}

}  // namespace metamer::lutgen
