// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <string>

namespace metamer::lutgen {

/// Progress in per cent on stderr: on a terminal, one line that changes a few times a second; elsewhere, as in the log
/// of a farm, a line each now and then once the work takes long. Nothing with --quiet.
class Progress {
 public:
  /// @param isAsked  whether the user asks for the changing line wherever stderr goes
  explicit Progress(std::string what, bool isAsked = false);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// @param share  0 ... 1
  void show(double share);

 private:
  std::string m_what;
  bool m_isLine;
  bool m_hasWritten = false;
  std::chrono::steady_clock::time_point m_last;
};

}  // namespace metamer::lutgen
