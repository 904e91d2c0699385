// SPDX-License-Identifier: Apache-2.0
#include "operators/parallel.h"

#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/parallel_invoke.h>

namespace metamer::ocio {

void parallelFor(int count, const std::function<void(int)>& body) {
  oneapi::tbb::parallel_for(0, count, body, oneapi::tbb::simple_partitioner());
}

void inParallel(const std::function<void()>& one, const std::function<void()>& other) {
  oneapi::tbb::parallel_invoke(one, other);
}

}  // namespace metamer::ocio
