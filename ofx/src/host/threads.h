// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "host/host.h"

namespace metamer::ofx {

/// Calls body(worker) once for each worker 0 ... n - 1 and returns when all have returned: through the host's
/// multi-thread suite where it has one, else on threads of our own. n is what the host grants, what the machine has,
/// and at most `most`. The workers share the work out among themselves.
/// @throws what a body threw (one of them, where several did)
void runWorkers(const HostSuites& host, int most, const std::function<void(int worker)>& body);

}  // namespace metamer::ofx
