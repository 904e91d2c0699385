// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

namespace metamer::ocio {

/// Calls `body` with 0 ... count - 1, shared among the machine's threads; the calls must not depend on each other.
/// The first exception thrown by a call is thrown again here.
void parallelFor(int count, const std::function<void(int)>& body);

}  // namespace metamer::ocio
