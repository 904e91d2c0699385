// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "geometry/embree_scene.h"
#include "geometry/geometry.h"
#include "lights/alias_table.h"
#include "lights/light_kinds.h"
#include "lights/light_sample.h"
#include "lights/light_tree.h"
#include "metamer/spectral/vector_lanes.h"
#include "metamer/spectral_ref/scene.h"
#include "wavelengths/lanes.h"

namespace metamer::spectral_ref {

/// Where on the lights a sample lies, whoever looks at it: what a reservoir keeps.
struct LightPoint {
  std::uint32_t entry = 0;
  float u = 0;
  float v = 0;
};

/// All emitters: chosen in proportion to their power, sampled uniformly over their area or solid angle.
///
/// An emitter is an emitting shape, the environment, a point or a spot light. Its elements (pixels of a picture,
/// triangles of a mesh, else one) are the entries that the choice is made among.
class LightTable {
 public:
  LightTable(const Scene& scene, const EmbreeScene& shapes);

  bool empty() const { return m_choice.empty(); }
  std::size_t entryCount() const { return m_choice.size(); }
  /// Entries that are not infinitely far.
  std::size_t nearCount() const { return m_nearCount; }
  /// The only light, if that is a rectangle that shines evenly: nothing is to be chosen. Else null.
  const RectangleEmitter* onlyRectangle() const;
  bool hasEnvironment() const { return m_environment != kNone; }

  /// Draws an entry by power.
  LightPoint choose(std::uint32_t bits, float u, float v) const { return {m_choice.sample(bits), u, v}; }
  /// The point as seen from `from`; pdf 0 where it is not (behind a one-sided light).
  LightSample sample(const LightPoint& point, const Vec3& from) const {
    LightSample sample = located(point, from);
    sample.pdf *= m_choice.probability(point.entry);
    return sample;
  }
  /// The same with the density that the point has once its entry is chosen.
  LightSample located(const LightPoint& point, const Vec3& from) const;
  /// Where a point lies, if its light has an area that it is drawn from.
  std::optional<AreaPoint> areaPoint(const LightPoint& point) const;

  /// What located() comes to: the receiver's cosine times scale over density; 0 where the point is not seen.
  float geometry(const LightPoint& point, const Vec3& from, const Vec3& normal) const;

  /// Density with which choose() and sample() at `from` find what a ray hit.
  float pdf(const Hit& hit, const Vec3& from, const Vec3& direction) const {
    return m_choice.probability(entryOf(hit)) * locatedPdf(hit, from, direction);
  }
  float environmentPdf(const Vec3& direction) const {
    return m_choice.probability(environmentEntry(direction)) * locatedEnvironmentPdf(direction);
  }
  /// Of the entry.
  float probability(std::uint32_t entry) const { return m_choice.probability(entry); }
  /// The same once the entry is chosen.
  float locatedPdf(const Hit& hit, const Vec3& from, const Vec3& direction) const;
  float locatedEnvironmentPdf(const Vec3& direction) const;
  /// Entry that an emitting hit, or a direction into the environment, belongs to.
  std::uint32_t entryOf(const Hit& hit) const { return m_emitters[hit.emitter].first + elementOf(hit); }
  std::uint32_t environmentEntry(const Vec3& direction) const {
    return m_emitters[m_environment].first + environmentElement(direction);
  }

  /// Where each entry lies and shines. @param scene  the one the table was made from
  std::vector<LightBounds> bounds(const Scene& scene) const;

  /// Element of an emitter that a hit lies on.
  std::uint32_t elementOf(const Hit& hit) const;
  std::uint32_t environmentEmitter() const { return m_environment; }
  std::uint32_t environmentElement(const Vec3& direction) const;

  /// Sum over lanes of an entry's radiance times a factor.
  template <int C>
  float response(std::uint32_t entry, const SpectrumTables& spectra, const std::array<std::int16_t, C>& cells,
                 const std::array<float, C>& factors) const {
    const Emitter& source = m_emitters[m_emitterOfEntry[entry]];
    const auto ofSpectrum = [&](SpectrumId id) {
      const float* values = spectra.table(id);
      float sum = 0;
      for (std::size_t k = 0; k < C; ++k) {
        sum += factors[k] * values[cells[k]];
      }
      return sum;
    };
    if (source.glow.picture == nullptr) {
      return ofSpectrum(source.glow.spectrum);
    }
    const EmitterPicture& picture = *source.glow.picture;
    const float* drives = picture.drives.data() + std::size_t{entry - source.first} * picture.emitters.size();
    float sum = 0;
    for (std::size_t k = 0; k < picture.emitters.size(); ++k) {
      sum += drives[k] * ofSpectrum(picture.emitters[k]);
    }
    return sum;
  }

  /// Radiance (point and spot lights: intensity) towards the side that emits.
  template <int C>
  METAMER_ALWAYS_INLINE Lanes<C> radiance(std::uint32_t emitter, std::uint32_t element, const SpectrumTables& spectra,
                                          const WavelengthSet<C>& wavelengths) const {
    const Emitter& source = m_emitters[emitter];
    if (source.glow.picture == nullptr) {
      return spectra.at(source.glow.spectrum, wavelengths);
    }
    const EmitterPicture& picture = *source.glow.picture;
    const float* drives = picture.drives.data() + std::size_t{element} * picture.emitters.size();
    Lanes<C> sum = Lanes<C>::Zero();
    for (std::size_t k = 0; k < picture.emitters.size(); ++k) {
      sum += drives[k] * spectra.at(picture.emitters[k], wavelengths);
    }
    return sum;
  }
  /// The same of an entry.
  template <int C>
  METAMER_ALWAYS_INLINE Lanes<C> radianceOf(std::uint32_t entry, const SpectrumTables& spectra,
                                            const WavelengthSet<C>& wavelengths) const {
    const std::uint32_t emitter = m_emitterOfEntry[entry];
    return radiance<C>(emitter, entry - m_emitters[emitter].first, spectra, wavelengths);
  }

 private:
  struct Emitter {
    EmitterKind kind;
    Glow glow;
    std::uint32_t first = 0;  ///< entry of element 0
  };
  const EnvironmentEmitter& environment() const { return std::get<EnvironmentEmitter>(m_emitters[m_environment].kind); }
  template <typename Kind>
  void collect(const Scene& scene, const EmbreeScene& shapes);
  std::vector<double> worths(const Scene& scene) const;

  std::vector<Emitter> m_emitters;
  std::vector<std::uint32_t> m_emitterOfEntry;
  AliasTable m_choice;
  std::uint32_t m_environment = kNone;
  std::size_t m_nearCount = 0;
};

}  // namespace metamer::spectral_ref
