// SPDX-License-Identifier: Apache-2.0
#include "pixels/spectral_pixels.h"

#include <algorithm>
#include <atomic>
#include <functional>
#include <utility>

#include "host/threads.h"
#include "pixels/encoded_pixels.h"

namespace metamer::ofx {

namespace {

/// Not on the host's: those may be the very ones that wait for the map.
void onOwnThreads(int count, const std::function<void(int)>& body) {
  std::atomic<int> next = 0;
  runWorkers(HostSuites{}, count, [&](int /*worker*/) {
    for (int i = next++; i < count; i = next++) {
      body(i);
    }
  });
}

}  // namespace

SpectralEngine::SpectralEngine(const sip::TransformSpec& spec, EngineMemory& memory, EngineMemory& draftMemory)
    : m_memory(memory), m_draftMemory(draftMemory) {
  onOwnThreads(2, [&](int which) {
    if (which == 0) {
      m_exact.emplace(spec, sip::kDefaultBandCount, &memory.scenes);
    } else {
      m_coarse.emplace(spec, kDraftBandCount, &draftMemory.scenes);
    }
  });
}

const sip::HomogeneousMap& SpectralEngine::map() const {
  const std::lock_guard lock(m_mutex);
  if (!m_map) {
    m_map = sip::buildHomogeneousMap(*m_exact, sip::kDefaultMapTolerance, onOwnThreads, &m_memory.maps);
    m_hasMap = true;
  }
  return *m_map;
}

const sip::HomogeneousMap& SpectralEngine::draftMap() const {
  if (m_hasMap) {
    return *m_map;
  }
  const std::lock_guard lock(m_draftMutex);
  if (!m_draft) {
    m_draft =
        sip::buildHomogeneousMap(*m_coarse, kDraftTolerance, onOwnThreads, &m_draftMemory.maps, kDraftFewerLevels);
  }
  return *m_draft;
}

namespace {

class SpectralPixels final : public PixelTransform {
 public:
  SpectralPixels(std::shared_ptr<const SpectralEngine> engine, std::optional<spectral::LogEncoding> encoding,
                 std::shared_ptr<const SignalTable> table, Quality quality)
      : m_engine(std::move(engine)), m_encoding(encoding), m_table(std::move(table)), m_quality(quality) {}

  void prepare(RenderQuality quality) const override {
    if (m_quality == Quality::Map) {
      m_map = quality == RenderQuality::Draft ? &m_engine->draftMap() : &m_engine->map();
    }
  }

  void apply(std::span<const float> source, std::span<float> destination) const override {
    if (!m_encoding) {
      applyLinear(source, destination);
      return;
    }
    throughEncoding(*m_encoding, m_quality == Quality::Map ? m_table.get() : nullptr, source, destination,
                    [this](std::span<const float> from, std::span<float> to) { applyLinear(from, to); });
  }

  bool isIdentity() const override { return m_engine->exact().isIdentity(); }
  bool isHomogeneous() const override { return !m_encoding; }
  std::optional<DeviceForm> deviceForm() const override {
    const sip::HomogeneousMap* const map = m_map;
    if (map == nullptr) {
      return std::nullopt;
    }
    return DeviceForm{DeviceForm::Kernel::Map, &m_engine->resident(*map), m_encoding ? &m_table->resident() : nullptr};
  }

 private:
  void applyLinear(std::span<const float> source, std::span<float> destination) const {
    if (const sip::HomogeneousMap* map = m_map) {
      map->apply(source, destination);
      return;
    }
    if (source.data() != destination.data()) {
      std::copy(source.begin(), source.end(), destination.begin());
    }
    m_engine->exact().apply(destination);
  }

  std::shared_ptr<const SpectralEngine> m_engine;
  std::optional<spectral::LogEncoding> m_encoding;
  std::shared_ptr<const SignalTable> m_table;
  Quality m_quality;
  mutable std::atomic<const sip::HomogeneousMap*> m_map = nullptr;  // of m_engine
};

}  // namespace

std::unique_ptr<PixelTransform> makeSpectralPixels(std::shared_ptr<const SpectralEngine> engine,
                                                   std::optional<spectral::LogEncoding> encoding,
                                                   std::shared_ptr<const SignalTable> table, Quality quality) {
  return std::make_unique<SpectralPixels>(std::move(engine), encoding, std::move(table), quality);
}

}  // namespace metamer::ofx
