// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <string>

namespace metamer::lutgen {

/// Progress in per cent on stderr, where that is a terminal or the user asks for it; a few times a second at most.
class Progress {
 public:
  Progress(std::string what, bool isAsked);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// @param share  0 ... 1
  void show(double share);

 private:
  std::string m_what;
  bool m_isShown;
  bool m_hasWritten = false;
  std::chrono::steady_clock::time_point m_last;
};

}  // namespace metamer::lutgen
