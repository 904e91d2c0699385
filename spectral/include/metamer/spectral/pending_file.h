// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

#include "metamer/spectral/interruption.h"

namespace metamer::spectral {

/// A file that appears whole or not at all: written beside its place under another name with the same extension, then
/// renamed over it. Never committed, it is removed again, also when a signal ends the program.
///
/// A link is followed, and a file that is replaced keeps its mode. A device, a pipe and a stream of the program
/// (/dev/stdout) are never replaced: what was written is copied into them, in one go at the end.
class PendingFile {
 public:
  /// @throws InputError where the folder is not there or cannot be written to, the file is write-protected, or the
  ///         place is a folder, a disk, a socket or a link that leads nowhere
  explicit PendingFile(std::filesystem::path target);
  ~PendingFile();
  PendingFile(const PendingFile&) = delete;
  PendingFile& operator=(const PendingFile&) = delete;

  /// Where to write until then. The file is there, and empty.
  const std::filesystem::path& path() const { return m_path; }
  /// As it was given.
  const std::filesystem::path& target() const { return m_target; }
  /// Whether the target is a device, a pipe or a stream: nothing can stand beside it.
  bool isStream() const { return m_isStream; }

  /// Writes the whole contents. @throws InputError (full disk)
  void write(std::string_view contents);

  /// @throws InputError where the target cannot be replaced, or a stream takes no more
  void commit();

 private:
  void copyIntoStream() const;
  void finish();

  std::filesystem::path m_target;
  std::filesystem::path m_place;  ///< behind links
  std::filesystem::path m_path;
  std::optional<Unfinished> m_unfinished;
  bool m_isStream = false;
  bool m_committed = false;
};

/// Commits files that belong together, streams first: no signal comes between files. @throws InputError as PendingFile
void commitAll(const std::vector<PendingFile*>& files);

/// Writes a file that appears whole or not at all. @throws InputError as PendingFile
void writeWholeFile(const std::filesystem::path& target, std::string_view contents);

/// Whether a file that a user names is a device, a pipe or a stream of the program. @throws InputError as PendingFile
bool isStream(const std::filesystem::path& target);

/// Says before the work what would fail after it. An empty name is no file. @throws InputError as PendingFile
void requireWritable(const std::filesystem::path& target);

}  // namespace metamer::spectral
