// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdlib>
#include <string>

#include "metamer/spectral/input_error.h"

namespace metamer {

/// What every refusal must be: one short line. Anything else stops the fuzzer.
inline void checkRefusal(const spectral::InputError& error) {
  const std::string message = error.what();
  if (message.find('\n') != std::string::npos || message.size() > 400) {
    std::abort();
  }
}

/// For promises of what was read.
inline void require(bool holds) {
  if (!holds) {
    std::abort();
  }
}

}  // namespace metamer
