// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <optional>

#include "metamer/sip/homogeneous_map.h"
#include "metamer/sip/map_memory.h"
#include "metamer/sip/scene_cache.h"
#include "metamer/sip/spectral_transform.h"
#include "metamer/spectral/log_encoding.h"
#include "pixels/pixel_transform.h"
#include "pixels/signal_table.h"

namespace metamer::ofx {

/// A draft's bands, the tolerance of its map, and the levels of patches that it does without: a frame while a slider
/// is drawn, on a photograph within a hundredth of a pixel's largest channel (99th percentile).
inline constexpr int kDraftBandCount = 41;
inline constexpr double kDraftTolerance = 0.35;
inline constexpr int kDraftFewerLevels = 3;

/// What other engines had to solve, for final frames or for drafts. Outlives them all.
struct EngineMemory {
  sip::SceneCache scenes;
  sip::MapMemory maps;
};

/// An engine with its map, the map built when it is first asked for.
class SpectralEngine {
 public:
  /// @throws spectral::InputError as SpectralTransform does
  SpectralEngine(const sip::TransformSpec& spec, EngineMemory& memory, EngineMemory& draftMemory);

  const sip::SpectralTransform& exact() const { return *m_exact; }
  /// Safe from several threads: one builds, the others wait.
  const sip::HomogeneousMap& map() const;
  /// map() where it is there; else a coarse one, in a fraction of the time.
  const sip::HomogeneousMap& draftMap() const;
  /// Of a map that one of these has returned.
  const ResidentTables& resident(const sip::HomogeneousMap& map) const {
    return m_hasMap && &map == &*m_map ? m_residentMap : m_residentDraft;
  }

 private:
  EngineMemory& m_memory;
  EngineMemory& m_draftMemory;
  std::optional<sip::SpectralTransform> m_exact;
  std::optional<sip::SpectralTransform> m_coarse;  ///< for drafts
  mutable std::mutex m_mutex;
  mutable std::optional<sip::HomogeneousMap> m_map;
  mutable std::atomic<bool> m_hasMap = false;
  mutable std::mutex m_draftMutex;
  mutable std::optional<sip::HomogeneousMap> m_draft;
  ResidentTables m_residentMap{[this] { return sip::deviceTables(*m_map); }};
  ResidentTables m_residentDraft{[this] { return sip::deviceTables(*m_draft); }};
};

enum class Quality { Map, Exact };

/// An engine on the pixels of a colour space.
/// @param encoding  of the pixels; none: they are linear
/// @param table     of that encoding, for Quality::Map; may be null otherwise
std::unique_ptr<PixelTransform> makeSpectralPixels(std::shared_ptr<const SpectralEngine> engine,
                                                   std::optional<spectral::LogEncoding> encoding,
                                                   std::shared_ptr<const SignalTable> table, Quality quality);

}  // namespace metamer::ofx
