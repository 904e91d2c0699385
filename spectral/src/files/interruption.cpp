// SPDX-License-Identifier: Apache-2.0
#include "metamer/spectral/interruption.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <string>
#include <thread>

#if defined(_WIN32)
#include <io.h>
#else
#include <unistd.h>
#endif

namespace metamer::spectral {
namespace {

/// A handler can reach nothing but globals, and may neither allocate nor lock: slots are never given back, only reused.
struct Slot {
  std::atomic<bool> isTaken = false;
  std::atomic<bool> isUnfinished = false;
  std::array<std::filesystem::path::value_type, 4096> path{};
  Slot* next = nullptr;
};

std::atomic<Slot*> firstSlot = nullptr;     // NOLINT
std::atomic<unsigned> finishedFiles = 0;    // NOLINT
std::atomic<int> waits = 0;                 // NOLINT
std::atomic<int> waitingSignal = 0;         // NOLINT
std::atomic<bool> isEnding = false;         // NOLINT
thread_local int waitsOfThread = 0;         // NOLINT
std::atomic<const char*> programName = "";  // NOLINT

Slot* takeSlot() {
  for (Slot* slot = firstSlot; slot != nullptr; slot = slot->next) {
    if (!slot->isTaken.exchange(true)) {
      return slot;
    }
  }
  auto* slot = new Slot;
  slot->isTaken = true;
  slot->next = firstSlot;
  while (!firstSlot.compare_exchange_weak(slot->next, slot)) {
  }
  return slot;
}

bool removePath(const std::filesystem::path::value_type* path) {
#if defined(_WIN32)
  return _wunlink(path) == 0 || _wrmdir(path) == 0;
#else
  return unlink(path) == 0 || rmdir(path) == 0;
#endif
}

void say(const char* text) {
#if defined(_WIN32)
  static_cast<void>(_write(2, text, static_cast<unsigned>(std::strlen(text))));
#else
  if (write(STDERR_FILENO, text, std::strlen(text)) < 0) {
    return;
  }
#endif
}

const char* nameOf(int signal) {
  switch (signal) {
    case SIGINT:
      return "SIGINT";
    case SIGTERM:
      return "SIGTERM";
    default:
      return "SIGHUP";
  }
}

/// As often as something goes: a folder is empty only once what it holds is gone.
void removeUnfinished() {
  bool hasRemoved = true;
  while (hasRemoved) {
    hasRemoved = false;
    for (Slot* slot = firstSlot; slot != nullptr; slot = slot->next) {
      hasRemoved = (slot->isUnfinished && removePath(slot->path.data())) || hasRemoved;
    }
  }
}

void report(int signal) {
#if !defined(_WIN32)
  if (signal == SIGPIPE) {
    return;  // whoever read is gone, and knows
  }
#endif
  say(programName);
  say(": stopped by ");
  say(nameOf(signal));
  unsigned count = finishedFiles;
  if (count == 0) {
    say("; nothing was written\n");
    return;
  }
  std::array<char, 16> digits{};
  std::size_t at = digits.size() - 1;
  for (; count > 0; count /= 10) {
    digits[--at] = static_cast<char>('0' + count % 10);
  }
  say("; files that are complete: ");
  say(&digits[at]);
  say("\n");
}

/// Other threads run on until the end. Those that come to a SignalsWait stay there, so that nothing gets its place
/// after it was counted; or the signal finds them in it, and the last of them ends the program.
extern "C" void endBy(int signal) {
  waitingSignal = signal;
  isEnding = true;
  if (waits > 0) {
    isEnding = false;
    return;
  }
  if (waitingSignal.exchange(0) == 0) {
    return;  // another thread has taken it over
  }
  removeUnfinished();
  report(signal);
  removeUnfinished();  // what a library has opened by its name meanwhile
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

void leave() {
  if (--waits == 0) {
    if (const int signal = waitingSignal.exchange(0)) {
      endBy(signal);
    }
  }
}

#if !defined(_WIN32)
void handle(int signal) {
  struct sigaction before = {};
  if (sigaction(signal, nullptr, &before) == 0 && before.sa_handler == SIG_IGN) {
    return;
  }
  struct sigaction action = {};
  action.sa_handler = endBy;
  // Not blocked within the handler: it ends by the same signal.
  action.sa_flags = SA_NODEFER | SA_RESTART;
  sigaction(signal, &action, nullptr);
}
#endif

}  // namespace

Unfinished::Unfinished(const std::filesystem::path& path) : m_slot(nullptr) {
  const std::filesystem::path place = std::filesystem::absolute(path);
  const std::filesystem::path::string_type& name = place.native();
  Slot* slot = takeSlot();
  if (name.size() < slot->path.size()) {
    std::copy_n(name.c_str(), name.size() + 1, slot->path.data());
    slot->isUnfinished = true;
  }
  m_slot = slot;
}

Unfinished::~Unfinished() {
  auto* slot = static_cast<Slot*>(m_slot);
  slot->isUnfinished = false;
  slot->isTaken = false;
}

SignalsWait::SignalsWait() {
  if (++waitsOfThread > 1) {
    return;
  }
  ++waits;
  while (isEnding || waitingSignal != 0) {
    leave();
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    ++waits;
  }
}

SignalsWait::~SignalsWait() {
  if (--waitsOfThread == 0) {
    leave();
  }
}

void countFinishedFile() {
  ++finishedFiles;
}

void endCleanlyBySignals(const char* program) {
  programName = program;
  finishedFiles = 0;
#if defined(_WIN32)
  std::signal(SIGINT, endBy);
  std::signal(SIGTERM, endBy);
#else
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGPIPE}) {
    handle(signal);
  }
  std::signal(SIGXFSZ, SIG_IGN);
#endif
}

void endBySignal(int signal) {
  std::signal(signal, SIG_DFL);
  std::raise(signal);
  std::_Exit(128 + signal);
}

}  // namespace metamer::spectral
