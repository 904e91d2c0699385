// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <optional>
#include <string>

namespace metamer::spectral_ref {

/// How a render tells of its progress.
enum class ProgressForm {
  Automatic,           ///< a changing line where stderr is a terminal, else Lines
  Lines,               ///< on stderr, one every half minute: for a log
  OpenJobDescription,  ///< on stdout, in the words that engines of Open Job Description read
  Off
};

/// @param name  auto, lines, openjd, off
ProgressForm progressFormNamed(const std::string& name);

/// Tells of a render's progress.
class Progress {
 public:
  explicit Progress(ProgressForm form);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Whether anything is said now: the error need not be measured for nobody.
  bool isDue() const;
  /// @param done     0 ... 1
  /// @param error    expected CIEDE2000 by noise, where known
  void show(double done, unsigned long long samples, std::optional<double> error, double secondsLeft);

 private:
  using Clock = std::chrono::steady_clock;

  ProgressForm m_form;
  bool m_isTerminal;
  Clock::time_point m_last = Clock::now();
  std::size_t m_length = 0;
};

}  // namespace metamer::spectral_ref
