// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <mutex>
#include <optional>

#include "metamer/sip/homogeneous_map.h"
#include "metamer/sip/spectral_transform.h"
#include "metamer/spectral/log_encoding.h"
#include "pixels/pixel_transform.h"
#include "pixels/signal_table.h"

namespace metamer::ofx {

/// An engine with its map, the map built when it is first asked for.
class SpectralEngine {
 public:
  /// @param memory  of other engines' maps; outlives this
  SpectralEngine(sip::SpectralTransform transform, const sip::MapMemory& memory)
      : m_exact(std::move(transform)), m_memory(memory) {}

  const sip::SpectralTransform& exact() const { return m_exact; }
  /// Safe from several threads: one builds, the others wait.
  const sip::HomogeneousMap& map() const;

 private:
  sip::SpectralTransform m_exact;
  const sip::MapMemory& m_memory;
  mutable std::mutex m_mutex;
  mutable std::optional<sip::HomogeneousMap> m_map;
};

enum class Quality { Map, Exact };

/// An engine on the pixels of a colour space.
/// @param encoding  of the pixels; none: they are linear
/// @param table     of that encoding, for Quality::Map; may be null otherwise
std::unique_ptr<PixelTransform> makeSpectralPixels(std::shared_ptr<const SpectralEngine> engine,
                                                   std::optional<spectral::LogEncoding> encoding,
                                                   std::shared_ptr<const SignalTable> table, Quality quality);

}  // namespace metamer::ofx
