// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <list>
#include <mutex>

namespace metamer::ofx {

/// The few entries that were asked for last. Safe between threads.
template <typename Entry>
class RecentlyUsed {
 public:
  /// A copy of the entry for which `isIt`; `make` makes it where there is none, one at a time. @throws what make throws
  template <typename IsIt, typename Make>
  Entry get(const IsIt& isIt, const Make& make) {
    const std::lock_guard lock(m_mutex);
    const auto found = std::find_if(m_entries.begin(), m_entries.end(), isIt);
    if (found != m_entries.end()) {
      m_entries.splice(m_entries.begin(), m_entries, found);
    } else {
      m_entries.push_front(make());
      if (m_entries.size() > kKept) {
        m_entries.pop_back();
      }
    }
    return m_entries.front();
  }

 private:
  static constexpr std::size_t kKept = 8;

  std::mutex m_mutex;
  std::list<Entry> m_entries;  ///< latest first
};

}  // namespace metamer::ofx
