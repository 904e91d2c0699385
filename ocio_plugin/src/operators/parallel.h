// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

namespace metamer::ocio {

/// Calls `body` with 0 ... count - 1, shared among the machine's threads; the calls must not depend on each other.
/// The first exception thrown by a call is thrown again here.
void parallelFor(int count, const std::function<void(int)>& body);

/// Calls both at once, where there are threads for it; neither may depend on the other. Exceptions as above.
void inParallel(const std::function<void()>& one, const std::function<void()>& other);

}  // namespace metamer::ocio
