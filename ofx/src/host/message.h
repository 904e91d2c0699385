// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mutex>
#include <string>

#include "host/host.h"

namespace metamer::ofx {

/// What an instance tells the user, in the host's own place for it. Safe from several threads.
class MessageBoard {
 public:
  MessageBoard(const HostSuites& host, OfxImageEffectHandle instance) : m_host(host), m_instance(instance) {}

  /// Shows one line until clear(); the same text again is not shown anew. Hosts without persistent messages get an
  /// ordinary one, hosts without any get none.
  void show(const std::string& text);
  /// Shows what is no error, once in an instance's life, where the host has a place for it that interrupts nobody.
  void note(const std::string& text);
  /// Takes back what show() showed.
  void clear();

 private:
  const HostSuites& m_host;
  OfxImageEffectHandle m_instance;
  std::mutex m_mutex;
  std::string m_shown;
  bool m_hasNoted = false;
};

}  // namespace metamer::ofx
