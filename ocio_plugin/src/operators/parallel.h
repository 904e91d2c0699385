// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

namespace metamer::ocio {

/// Calls `body` with 0 ... count - 1, shared among threads; the calls must not depend on each other.
/// The first exception thrown by a call is thrown again here.
/// @param threads  0: as many as the machine has
void parallelFor(int count, const std::function<void(int)>& body, int threads = 0);

}  // namespace metamer::ocio
