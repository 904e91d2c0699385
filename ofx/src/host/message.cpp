// SPDX-License-Identifier: Apache-2.0
#include "host/message.h"

namespace metamer::ofx {
namespace {

constexpr const char* kMessageId = "metamer";

}  // namespace

void MessageBoard::show(const std::string& text) {
  const std::lock_guard lock(m_mutex);
  if (text == m_shown) {
    return;
  }
  m_shown = text;
  // The text may hold per cent signs: it is an argument, never the format.
  if (m_host.persistentMessage != nullptr) {
    m_host.persistentMessage->setPersistentMessage(m_instance, kOfxMessageError, kMessageId, "%s", text.c_str());
  } else if (m_host.message != nullptr) {
    m_host.message->message(m_instance, kOfxMessageError, kMessageId, "%s", text.c_str());
  }
}

void MessageBoard::note(const std::string& text) {
  const std::lock_guard lock(m_mutex);
  if (m_hasNoted || m_host.persistentMessage == nullptr || !m_shown.empty()) {
    return;
  }
  m_hasNoted = true;
  m_host.persistentMessage->setPersistentMessage(m_instance, kOfxMessageWarning, kMessageId, "%s", text.c_str());
}

void MessageBoard::clear() {
  const std::lock_guard lock(m_mutex);
  if (m_shown.empty()) {
    return;
  }
  m_shown.clear();
  if (m_host.persistentMessage != nullptr) {
    m_host.persistentMessage->clearPersistentMessage(m_instance);
  }
}

}  // namespace metamer::ofx
