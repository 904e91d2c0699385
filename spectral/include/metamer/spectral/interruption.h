// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

// All that outlives a function call for the sake of signals stands behind this file. Libraries only note down what is
// unfinished; a program decides at its start what a signal does.
namespace metamer::spectral {

/// A file, or a folder while it is empty, that goes when a signal ends the program. Not for longer than it lives.
class Unfinished {
 public:
  /// Before the path is made, so that there is no moment without.
  explicit Unfinished(const std::filesystem::path& path);
  ~Unfinished();
  Unfinished(const Unfinished&) = delete;
  Unfinished& operator=(const Unfinished&) = delete;

 private:
  void* m_slot;
};

/// Signals wait for as long as one of these lives: for changes that belong together.
class SignalsWait {
 public:
  SignalsWait();
  ~SignalsWait();
  SignalsWait(const SignalsWait&) = delete;
  SignalsWait& operator=(const SignalsWait&) = delete;
};

/// One file more is in its place: what a program tells when a signal ends it.
void countFinishedFile();

/// SIGINT, SIGTERM, SIGHUP and SIGPIPE remove what is unfinished, say on stderr what was done and end the program by
/// that signal, which a shell shows as 128 + its number; those that the caller ignores stay ignored. A file that grows
/// beyond the limit (SIGXFSZ) is an error where it is written, with a reason, no signal.
/// @param program  its name; the text must live on
void endCleanlyBySignals(const char* program);

/// Ends the program by a signal that it has caught itself.
[[noreturn]] void endBySignal(int signal);

}  // namespace metamer::spectral
