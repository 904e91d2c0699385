// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <filesystem>

#include "metamer/spectral/interruption.h"

namespace metamer::spectral {

/// A folder for what a program writes, and those above it, made where they are not there. Those it made go again while
/// they are empty, also when a signal ends the program, unless they are kept.
class PendingFolder {
 public:
  /// @throws InputError where it cannot be made, or the place is taken by a file
  explicit PendingFolder(const std::filesystem::path& path);
  ~PendingFolder();
  PendingFolder(const PendingFolder&) = delete;
  PendingFolder& operator=(const PendingFolder&) = delete;

  /// The folder stays, though it be empty.
  void keep() { m_made.clear(); }

 private:
  struct Made {
    explicit Made(const std::filesystem::path& place) : path(place), unfinished(place) {}
    std::filesystem::path path;
    Unfinished unfinished;
  };
  std::deque<Made> m_made;  ///< the innermost last
};

}  // namespace metamer::spectral
