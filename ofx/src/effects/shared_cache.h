// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <future>
#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <utility>

#include "effects/file_stamp.h"

namespace metamer::ofx {

/// Things that take time to build, kept by a text that says all that they depend on, and built once however many
/// threads ask. The latest `capacity` are kept; who holds one keeps it alive for longer.
template <typename Value>
class SharedCache {
 public:
  /// What a build returns: the value, and the files it was read from. When one of them changes, it is built anew.
  struct Built {
    std::shared_ptr<const Value> value;
    FileStamps files;
  };

  explicit SharedCache(std::size_t capacity) : m_capacity(capacity) {}

  /// @throws what the build throws; nothing is kept then
  std::shared_ptr<const Value> get(const std::string& key, const std::function<Built()>& build) {
    std::promise<Built> promise;
    std::shared_future<Built> existing;
    {
      const std::lock_guard lock(m_mutex);
      const auto entry = find(key);
      if (entry != m_entries.end()) {
        m_entries.splice(m_entries.begin(), m_entries, entry);
        existing = entry->built;
      } else {
        insert(key, promise.get_future().share());
      }
    }
    if (existing.valid()) {
      const Built& built = existing.get();
      if (built.files.areCurrent()) {
        return built.value;
      }
      remove(key, built.value);
      return get(key, build);
    }
    return fill(key, promise, build);
  }

 private:
  struct Entry {
    std::string key;
    std::shared_future<Built> built;
  };
  using Entries = std::list<Entry>;

  typename Entries::iterator find(const std::string& key) {
    auto entry = m_entries.begin();
    while (entry != m_entries.end() && entry->key != key) {
      ++entry;
    }
    return entry;
  }

  void insert(const std::string& key, std::shared_future<Built> built) {
    m_entries.push_front({key, std::move(built)});
    if (m_entries.size() > m_capacity) {
      m_entries.pop_back();
    }
  }

  std::shared_ptr<const Value> fill(const std::string& key, std::promise<Built>& promise,
                                    const std::function<Built()>& build) {
    try {
      Built built = build();
      std::shared_ptr<const Value> value = built.value;
      promise.set_value(std::move(built));
      return value;
    } catch (...) {
      remove(key, nullptr);
      promise.set_exception(std::current_exception());
      throw;
    }
  }

  /// Removes the entry that holds this value; null: the one whose build has failed.
  void remove(const std::string& key, const std::shared_ptr<const Value>& value) {
    const std::lock_guard lock(m_mutex);
    const auto entry = find(key);
    if (entry == m_entries.end()) {
      return;
    }
    const bool isReady = entry->built.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
    if (value == nullptr ? !isReady : isReady && entry->built.get().value == value) {
      m_entries.erase(entry);
    }
  }

  std::size_t m_capacity;
  std::mutex m_mutex;
  Entries m_entries;  ///< latest first
};

}  // namespace metamer::ofx
