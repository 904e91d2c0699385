// SPDX-License-Identifier: Apache-2.0
#include "metamer/sip/map_memory.h"

#include "map/map_memory_state.h"

namespace metamer::sip {

void PartMemory::beginBuild() {
  if (2 * m_kept.size() > 3 * m_used) {
    std::erase_if(m_kept, [&](const auto& one) { return one.second.usedBy != m_build; });
  }
  ++m_build;
  m_used = 0;
}

SpectralTransform::SolvedSpectrum* PartMemory::at(std::uint64_t place) {
  Kept& kept = m_kept[place];
  if (kept.usedBy != m_build) {
    kept.usedBy = m_build;
    ++m_used;
  }
  return &kept.spectrum;
}

MapMemory::MapMemory() : m_state(std::make_unique<State>()) {}
MapMemory::~MapMemory() = default;

std::shared_ptr<MapMemory::State::Parts> MapMemory::State::partsFor(const SpectralTransform& transform,
                                                                    std::size_t count) {
  const std::lock_guard lock(m_mutex);
  if (!m_parts || m_recovery != transform.recovery() || m_responseFromRgb != transform.responseFromRgb()) {
    m_recovery = transform.recovery();
    m_responseFromRgb = transform.responseFromRgb();
    m_parts = std::make_shared<Parts>(count);
  }
  return m_parts;
}

}  // namespace metamer::sip
