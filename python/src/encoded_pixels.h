// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "metamer/spectral/log_encoding.h"
#include "pixels.h"

namespace metamer::python {

/// A function of linear pixels as one of pixels in a log curve; the function itself where there is none.
PixelFunction onEncoded(const PixelFunction& linear, std::optional<spectral::LogEncoding> encoding);

}  // namespace metamer::python
