// SPDX-License-Identifier: Apache-2.0
#include "progress.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>

#include "metamer/spectral/platform.h"

namespace metamer::spectral_ref {

Progress::Progress() : m_isShown(spectral::errorStreamIsTerminal()) {}

Progress::~Progress() {
  if (m_isShown && m_length > 0) {
    std::cerr << '\r' << std::string(m_length, ' ') << '\r' << std::flush;
  }
}

void Progress::show(double done, unsigned long long samples, std::optional<double> error, double secondsLeft) {
  if (!m_isShown) {
    return;
  }
  constexpr int kWidth = 30;
  const int filled = static_cast<int>(std::lround(std::clamp(done, 0.0, 1.0) * kWidth));
  std::string line = "[" + std::string(static_cast<std::size_t>(filled), '#') +
                     std::string(static_cast<std::size_t>(kWidth - filled), '.') + "]";
  char text[128];
  std::snprintf(text, sizeof text, " %3.0f %%  %llu samples", 100.0 * std::clamp(done, 0.0, 1.0), samples);
  line += text;
  if (error && std::isfinite(*error)) {
    std::snprintf(text, sizeof text, "  noise %.2f dE", *error);
    line += text;
  }
  if (std::isfinite(secondsLeft)) {
    const auto seconds = static_cast<long long>(std::llround(std::min(secondsLeft, 1e9)));
    std::snprintf(text, sizeof text, "  %lld:%02lld:%02lld left", seconds / 3600, seconds / 60 % 60, seconds % 60);
    line += text;
  }
  const std::size_t length = line.size();
  line.resize(std::max(length, m_length), ' ');
  m_length = length;
  std::cerr << '\r' << line << std::flush;
}

}  // namespace metamer::spectral_ref
