// SPDX-License-Identifier: Apache-2.0
#include "operators/parallel.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace metamer::ocio {

void parallelFor(int count, const std::function<void(int)>& body, int threads) {
  const int wanted = threads > 0 ? threads : static_cast<int>(std::thread::hardware_concurrency());
  std::atomic<int> next = 0;
  std::exception_ptr failure;
  std::mutex failureMutex;
  const auto work = [&] {
    for (int i = next++; i < count; i = next++) {
      try {
        body(i);
      } catch (...) {
        const std::lock_guard lock(failureMutex);
        if (!failure) {
          failure = std::current_exception();
        }
        next = count;
      }
    }
  };
  std::vector<std::jthread> helpers;
  for (int i = 1; i < std::min(wanted, count); ++i) {
    helpers.emplace_back(work);
  }
  work();
  helpers.clear();
  if (failure) {
    std::rethrow_exception(failure);
  }
}

}  // namespace metamer::ocio
