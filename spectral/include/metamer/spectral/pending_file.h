// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string_view>

namespace metamer::spectral {

/// A file that appears whole or not at all: written beside its place under another name with the same extension, then
/// renamed over it. Never committed, it is removed again.
class PendingFile {
 public:
  /// @throws InputError where the folder is not there or cannot be written to
  explicit PendingFile(std::filesystem::path target);
  ~PendingFile();
  PendingFile(const PendingFile&) = delete;
  PendingFile& operator=(const PendingFile&) = delete;

  /// Where to write until then. The file is there, and empty.
  const std::filesystem::path& path() const { return m_path; }
  const std::filesystem::path& target() const { return m_target; }

  /// Writes the whole contents. @throws InputError (full disk)
  void write(std::string_view contents);

  /// @throws InputError where the target cannot be replaced
  void commit();

 private:
  std::filesystem::path m_target;
  std::filesystem::path m_path;
  bool m_committed = false;
};

/// Writes a file that appears whole or not at all. @throws InputError as PendingFile
void writeWholeFile(const std::filesystem::path& target, std::string_view contents);

}  // namespace metamer::spectral
