// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "metamer/spectral/argument_checks.h"
#include "metamer/spectral/input_error.h"

namespace metamer::skin {

/// @throws spectral::InputError where there are not three numbers a pixel
inline void requireThree(std::size_t values, std::size_t pixels) {
  if (values != 3 * pixels) {
    throw spectral::InputError("", "rgb", std::to_string(values),
                               "must be three numbers a pixel, " + std::to_string(3 * pixels));
  }
}

inline void requireThreads(int threads) {
  spectral::requireWithin("threads", threads, 1, 256);
}

}  // namespace metamer::skin
