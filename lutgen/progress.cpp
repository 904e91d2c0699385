// SPDX-License-Identifier: Apache-2.0
#include "progress.h"

#include <iostream>

#include "metamer/spectral/formatted.h"
#include "metamer/spectral/platform.h"
#include "run.h"

namespace metamer::lutgen {
namespace {

constexpr std::chrono::milliseconds kPause(250);
/// Between lines of a log. What is done sooner says nothing.
constexpr std::chrono::seconds kLogPause(10);

}  // namespace

Progress::Progress(std::string what, bool isAsked)
    : m_what(std::move(what)),
      m_isLine(isAsked || spectral::errorStreamIsTerminal()),
      m_last(std::chrono::steady_clock::now()) {}

Progress::~Progress() {
  if (m_hasWritten && m_isLine) {
    std::cerr << std::endl;
  }
}

void Progress::show(double share) {
  const auto now = std::chrono::steady_clock::now();
  const bool isDue = m_isLine ? !m_hasWritten || share >= 1 || now - m_last >= kPause : now - m_last >= kLogPause;
  if (!isDue || isQuiet()) {
    return;
  }
  m_last = now;
  m_hasWritten = true;
  std::cerr << spectral::formatted(m_isLine ? "\r%s %3.0f %%" : "lutgen: %s %.0f %%\n", m_what.c_str(), 100 * share)
            << std::flush;
}

}  // namespace metamer::lutgen
