// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

namespace metamer::sip {

/// The spectra that building a map solved, kept for the next map: one of the same shot seen under another light, behind
/// another gel or with the eye adapted otherwise takes a fraction of the time. Changes no map. Holds the spectra of the
/// latest input side, some tens of megabytes. Its transforms are to be made with one SceneCache, or it knows none
/// again. Safe to share between threads.
class MapMemory {
 public:
  MapMemory();
  ~MapMemory();
  MapMemory(const MapMemory&) = delete;
  MapMemory& operator=(const MapMemory&) = delete;

  struct State;
  /// For the builder.
  State& state() const { return *m_state; }

 private:
  std::unique_ptr<State> m_state;
};

}  // namespace metamer::sip
