// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "spectral/fixture.h"

/// Holds a call to an InputError whose text names what was out of range.
#define EXPECT_REFUSED(text, ...)                                                                              \
  EXPECT_NE(metamer::spectral::errorOf([&] { static_cast<void>(__VA_ARGS__); }).find(text), std::string::npos) \
      << metamer::spectral::errorOf([&] { static_cast<void>(__VA_ARGS__); })

/// Holds a call just inside the range to no error at all.
#define EXPECT_TAKEN(...) EXPECT_NO_THROW(static_cast<void>(__VA_ARGS__))
