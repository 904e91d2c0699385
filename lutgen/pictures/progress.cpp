// SPDX-License-Identifier: Apache-2.0
#include "progress.h"

#include <iostream>

#include "metamer/spectral/formatted.h"
#include "metamer/spectral/platform.h"

namespace metamer::lutgen {
namespace {

constexpr std::chrono::milliseconds kPause(250);

}  // namespace

Progress::Progress(std::string what, bool isAsked)
    : m_what(std::move(what)), m_isShown(isAsked || spectral::errorStreamIsTerminal()) {}

Progress::~Progress() {
  if (m_hasWritten) {
    std::cerr << std::endl;
  }
}

void Progress::show(double share) {
  const auto now = std::chrono::steady_clock::now();
  if (!m_isShown || (m_hasWritten && share < 1 && now - m_last < kPause)) {
    return;
  }
  m_last = now;
  m_hasWritten = true;
  std::cerr << spectral::formatted("\r%s %3.0f %%", m_what.c_str(), 100 * share) << std::flush;
}

}  // namespace metamer::lutgen
