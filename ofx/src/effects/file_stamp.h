// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace metamer::ofx {

/// Size and time of files, to see whether something read from them is out of date.
class FileStamps {
 public:
  /// Notes a file as it is now; one that is not there is noted as missing.
  void add(const std::filesystem::path& file);
  bool areCurrent() const;

 private:
  struct Stamp {
    std::filesystem::path file;
    std::uintmax_t size;
    std::filesystem::file_time_type time;
    bool operator==(const Stamp&) const = default;
  };
  static Stamp stampOf(const std::filesystem::path& file);

  std::vector<Stamp> m_stamps;
};

/// For files that a parameter names: the host shows the message, so it says which field and what to do.
/// @throws spectral::InputError where there is no file
void requireFile(const std::filesystem::path& file, const std::string& parameter, const std::string& remedy);

}  // namespace metamer::ofx
