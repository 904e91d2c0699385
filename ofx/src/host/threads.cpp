// SPDX-License-Identifier: Apache-2.0
#include "host/threads.h"

#include <algorithm>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace metamer::ofx {
namespace {

/// Runs bodies and keeps the first failure: none may cross the host's frames or end a thread.
class Team {
 public:
  explicit Team(const std::function<void(int)>& body) : m_body(body) {}

  void work(int worker) noexcept {
    try {
      m_body(worker);
    } catch (...) {
      const std::lock_guard lock(m_mutex);
      if (!m_failure) {
        m_failure = std::current_exception();
      }
    }
  }

  void rethrow() const {
    if (m_failure) {
      std::rethrow_exception(m_failure);
    }
  }

  static void hostThread(unsigned int index, unsigned int /*count*/, void* team) {
    static_cast<Team*>(team)->work(static_cast<int>(index));
  }

 private:
  const std::function<void(int)>& m_body;
  std::mutex m_mutex;
  std::exception_ptr m_failure;
};

/// False where the host would not run them, and none has run.
bool runOnHost(const OfxMultiThreadSuiteV1& suite, int most, Team& team) {
  unsigned int granted = 0;
  if (suite.multiThreadNumCPUs(&granted) != kOfxStatOK) {
    return false;
  }
  const unsigned int count = std::min(granted, static_cast<unsigned int>(most));
  if (count <= 1) {
    team.work(0);
    return true;
  }
  return suite.multiThread(Team::hostThread, count, &team) == kOfxStatOK;
}

}  // namespace

void runWorkers(const HostSuites& host, int most, const std::function<void(int worker)>& body) {
  Team team(body);
  if (most <= 1) {
    team.work(0);
  } else if (host.multiThread == nullptr) {
    const int count = std::min(most, std::max(1, static_cast<int>(std::thread::hardware_concurrency())));
    std::vector<std::jthread> helpers;
    try {
      for (int worker = 1; worker < count; ++worker) {
        helpers.emplace_back([&team, worker] { team.work(worker); });
      }
    } catch (const std::system_error&) {
      // No more threads to be had: those there are do it all.
    }
    team.work(0);
    helpers.clear();
  } else if (!runOnHost(*host.multiThread, most, team)) {
    // Called on one of the host's spawned threads, or the host has none to spare: this thread does it all.
    team.work(0);
  }
  team.rethrow();
}

}  // namespace metamer::ofx
