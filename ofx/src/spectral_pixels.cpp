// SPDX-License-Identifier: Apache-2.0
#include "spectral_pixels.h"

#include <algorithm>
#include <atomic>
#include <utility>

#include "signal_curve.h"

namespace metamer::ofx {

const sip::HomogeneousMap& SpectralEngine::map() const {
  const std::lock_guard lock(m_mutex);
  if (!m_map) {
    m_map = sip::buildHomogeneousMap(m_exact);
  }
  return *m_map;
}

namespace {

class SpectralPixels final : public PixelTransform {
 public:
  SpectralPixels(std::shared_ptr<const SpectralEngine> engine, std::optional<spectral::LogEncoding> encoding,
                 Quality quality)
      : m_engine(std::move(engine)), m_encoding(encoding), m_quality(quality) {}

  void prepare() const override {
    if (m_quality == Quality::Map) {
      m_map = &m_engine->map();
    }
  }

  void apply(std::span<const float> source, std::span<float> destination) const override {
    if (!m_encoding) {
      applyLinear(source, destination);
      return;
    }
    // Pixels may be in place: what is not finite is put back from a copy.
    const std::vector<float> signal(source.begin(), source.end());
    std::copy(source.begin(), source.end(), destination.begin());
    decodePixels(*m_encoding, destination);
    applyLinear(destination, destination);
    encodePixels(*m_encoding, destination);
    restoreNonFinite(signal, destination);
  }

  bool isIdentity() const override { return m_engine->exact().isIdentity(); }
  bool isHomogeneous() const override { return !m_encoding; }

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
  Quality m_quality;
  mutable std::atomic<const sip::HomogeneousMap*> m_map = nullptr;  // of m_engine
};

}  // namespace

std::unique_ptr<PixelTransform> makeSpectralPixels(std::shared_ptr<const SpectralEngine> engine,
                                                   std::optional<spectral::LogEncoding> encoding, Quality quality) {
  return std::make_unique<SpectralPixels>(std::move(engine), encoding, quality);
}

}  // namespace metamer::ofx
