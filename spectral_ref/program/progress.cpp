// SPDX-License-Identifier: Apache-2.0
#include "progress.h"

#include <algorithm>
#include <cmath>
#include <iostream>

#include "metamer/spectral/formatted.h"
#include "metamer/spectral/platform.h"

namespace metamer::spectral_ref {

namespace {

/// Between two lines of a log, seconds.
constexpr double kSecondsALine = 30;
/// Between two words to an engine, seconds.
constexpr double kSecondsAWord = 1;

std::string textOf(double done, unsigned long long samples, std::optional<double> error, double secondsLeft) {
  std::string text = spectral::formatted("%3.0f %%  %llu samples", 100.0 * std::clamp(done, 0.0, 1.0), samples);
  if (error && std::isfinite(*error)) {
    text += spectral::formatted("  noise %.2f dE", *error);
  }
  if (std::isfinite(secondsLeft)) {
    const auto seconds = static_cast<long long>(std::llround(std::min(secondsLeft, 1e9)));
    text += spectral::formatted("  %lld:%02lld:%02lld left", seconds / 3600, seconds / 60 % 60, seconds % 60);
  }
  return text;
}

}  // namespace

ProgressForm progressFormNamed(const std::string& name) {
  return name == "lines"    ? ProgressForm::Lines
         : name == "openjd" ? ProgressForm::OpenJobDescription
         : name == "off"    ? ProgressForm::Off
                            : ProgressForm::Automatic;
}

Progress::Progress(ProgressForm form)
    : m_form(form), m_isTerminal(form == ProgressForm::Automatic && spectral::errorStreamIsTerminal()) {}

Progress::~Progress() {
  if (m_isTerminal && m_length > 0) {
    std::cerr << '\r' << std::string(m_length, ' ') << '\r' << std::flush;
  }
}

bool Progress::isDue() const {
  const double interval = m_isTerminal                                 ? 0.0
                          : m_form == ProgressForm::OpenJobDescription ? kSecondsAWord
                                                                       : kSecondsALine;
  return m_form != ProgressForm::Off && std::chrono::duration<double>(Clock::now() - m_last).count() >= interval;
}

void Progress::show(double done, unsigned long long samples, std::optional<double> error, double secondsLeft) {
  if (!isDue()) {
    return;
  }
  m_last = Clock::now();
  const std::string text = textOf(done, samples, error, secondsLeft);
  if (m_form == ProgressForm::OpenJobDescription) {
    std::cout << spectral::formatted("openjd_progress: %.1f\n", 100.0 * std::clamp(done, 0.0, 1.0))
              << "openjd_status: " << text << std::endl;
    return;
  }
  if (!m_isTerminal) {
    std::cerr << "spectral_ref: " << text << std::endl;
    return;
  }
  constexpr int kWidth = 30;
  const auto filled = static_cast<std::size_t>(std::lround(std::clamp(done, 0.0, 1.0) * kWidth));
  std::string line = "[" + std::string(filled, '#') + std::string(kWidth - filled, '.') + "] " + text;
  const std::size_t length = line.size();
  line.resize(std::max(length, m_length), ' ');
  m_length = length;
  std::cerr << '\r' << line << std::flush;
}

}  // namespace metamer::spectral_ref
