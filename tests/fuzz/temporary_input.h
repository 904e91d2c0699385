// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

namespace metamer {

/// Bytes as a file, for readers that take nothing else: one a process, written over and over.
class TemporaryInput {
 public:
  TemporaryInput(const std::string& extension, const std::uint8_t* data, std::size_t size)
      : m_path(std::filesystem::temp_directory_path() / ("fuzz_" + std::to_string(getpid()) + extension)) {
    std::ofstream file(m_path, std::ios::binary | std::ios::trunc);
    file.write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
  }
  ~TemporaryInput() {
    std::error_code none;
    std::filesystem::remove(m_path, none);
  }
  TemporaryInput(const TemporaryInput&) = delete;
  TemporaryInput& operator=(const TemporaryInput&) = delete;

  const std::filesystem::path& path() const { return m_path; }

 private:
  std::filesystem::path m_path;
};

}  // namespace metamer
