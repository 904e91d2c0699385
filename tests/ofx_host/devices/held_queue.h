// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>

/// Work in order, of a device that is the processor: at once, or when the host no longer holds it.
class HeldQueue {
 public:
  void put(std::function<void()> work) {
    const std::lock_guard lock(m_mutex);
    if (m_isHeld) {
      m_work.push_back(std::move(work));
    } else {
      work();
    }
  }
  void hold() {
    const std::lock_guard lock(m_mutex);
    m_isHeld = true;
  }
  void letGo() {
    const std::lock_guard lock(m_mutex);
    for (const auto& work : m_work) {
      work();
    }
    m_work.clear();
    m_isHeld = false;
    m_changed.notify_all();
  }
  bool isEmpty() {
    const std::lock_guard lock(m_mutex);
    return !m_isHeld;
  }
  void wait() {
    std::unique_lock lock(m_mutex);
    m_changed.wait(lock, [&] { return !m_isHeld; });
  }

 private:
  std::mutex m_mutex;
  std::condition_variable m_changed;
  std::deque<std::function<void()>> m_work;
  bool m_isHeld = false;
};
