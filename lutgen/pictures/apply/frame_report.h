// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <iostream>
#include <string>
#include <utility>

#include "apply/sequence.h"
#include "metamer/spectral/path_text.h"
#include "metamer/spectral/platform.h"
#include "progress.h"
#include "run.h"

namespace metamer::lutgen {

/// What a farm's log and a person see of frames: a line each, or a share. Of one picture nothing.
class FrameReport {
 public:
  /// @param command  "lutgen apply"
  FrameReport(std::string command, std::size_t frameCount)
      : m_count(frameCount),
        m_hasLines(!isQuiet() && frameCount > 1 && !spectral::errorStreamIsTerminal()),
        m_hasShare(!isQuiet() && frameCount > 1 && !m_hasLines),
        m_progress(std::move(command), false) {}

  void done(const Frame& frame, std::size_t count) {
    if (m_hasLines) {
      std::cerr << "lutgen: frame " + std::to_string(frame.number) + " done, " + std::to_string(count) + " of " +
                       std::to_string(m_count) + ": " + spectral::utf8(frame.output) + "\n"
                << std::flush;
    } else if (m_hasShare) {
      m_progress.show(static_cast<double>(count) / static_cast<double>(m_count));
    }
  }

 private:
  std::size_t m_count;
  bool m_hasLines;
  bool m_hasShare;
  Progress m_progress;
};

}  // namespace metamer::lutgen
