// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

namespace metamer::spectral_ref {

/// The progress line of a render, on stderr where that is a terminal and nowhere else.
class Progress {
 public:
  Progress();
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  bool isShown() const { return m_isShown; }
  /// @param done     0 ... 1
  /// @param error    expected CIEDE2000 by noise, where known
  void show(double done, unsigned long long samples, std::optional<double> error, double secondsLeft);

 private:
  bool m_isShown;
  std::size_t m_length = 0;
};

}  // namespace metamer::spectral_ref
