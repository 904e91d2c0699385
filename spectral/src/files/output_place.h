// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdio>
#include <filesystem>

namespace metamer::spectral {

/// Where a file that a user names is written.
struct OutputPlace {
  std::filesystem::path path;  ///< behind links
  bool isStream = false;       ///< a device, a pipe or a stream of the program: to be written into, never replaced
};

/// @throws InputError: a folder, a disk, a socket, a link that leads nowhere, a write-protected file, a new name in
/// /dev
OutputPlace outputPlace(const std::filesystem::path& target);

/// Opens a stream to write into: one of the program's own at its place, whatever it is. Null with errno.
std::FILE* openStream(const std::filesystem::path& path);

/// Gives a file the mode of another, and its owner where that is allowed; nothing where the other is not there.
void keepOwnerAndMode(const std::filesystem::path& from, const std::filesystem::path& to);

}  // namespace metamer::spectral
