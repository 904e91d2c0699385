// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <thread>
#include <vector>

namespace metamer::skin {

/// Calls work(begin, end) for equal shares of 0 ... count, each on a thread of its own. What the work does must not
/// throw.
inline void inParallel(std::size_t count, int threads, const std::function<void(std::size_t, std::size_t)>& work) {
  const std::size_t shares =
      std::clamp<std::size_t>(static_cast<std::size_t>(threads), 1, std::max<std::size_t>(count, 1));
  std::vector<std::jthread> running;
  for (std::size_t share = 1; share < shares; ++share) {
    running.emplace_back(work, count * share / shares, count * (share + 1) / shares);
  }
  work(0, count / shares);
}

}  // namespace metamer::skin
