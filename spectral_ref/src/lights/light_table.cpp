// SPDX-License-Identifier: Apache-2.0
#include "lights/light_table.h"

#include <algorithm>
#include <cassert>
#include <limits>
#include <type_traits>
#include <utility>
#include <variant>

namespace metamer::spectral_ref {
namespace {

/// What a spectrum is worth when lights are chosen: mostly its luminance, a little its whole power, so that light of
/// any wavelength has its chance. Where surfaces fluoresce, what cannot be seen counts as much as what can.
double worth(const Scene& scene, SpectrumId id, const spectral::DomainSamples& luminance) {
  const spectral::DomainSamples& spectrum = scene.spectra[id];
  const bool isExciting = !scene.fluorescences.empty();
  const double invisibleShare = isExciting ? 0.5 : 0.1;
  const double ultraviolet =
      isExciting ? UltravioletSamples(scene.whole(id).head<spectral::kDomainInExcitation>()).sum() : 0.0;
  return (1.0 - invisibleShare) * spectrum.dot(luminance) +
         invisibleShare * (spectrum.mean() + ultraviolet / spectral::kDomainSize);
}

}  // namespace

template <typename Kind>
void LightTable::collect(const Scene& scene, const EmbreeScene& shapes) {
  Kind::collect(scene, shapes, [&](const Kind& kind, const Glow& glow, std::size_t elements, std::uint32_t number) {
    const auto index = static_cast<std::uint32_t>(m_emitters.size());
    assert(number == kNone || number == index);
    static_cast<void>(number);
    if constexpr (std::is_same_v<Kind, EnvironmentEmitter>) {
      m_environment = index;
    } else {
      m_nearCount += elements;
    }
    m_emitters.push_back({kind, glow, static_cast<std::uint32_t>(m_emitterOfEntry.size())});
    m_emitterOfEntry.insert(m_emitterOfEntry.end(), elements, index);
  });
}

LightTable::LightTable(const Scene& scene, const EmbreeScene& shapes) {
  [&]<std::size_t... Kinds>(std::index_sequence<Kinds...>) {
    (collect<std::variant_alternative_t<Kinds, EmitterKind>>(scene, shapes), ...);
  }
  (std::make_index_sequence<std::variant_size_v<EmitterKind>>());
  std::vector<double> powers = worths(scene);
  for (std::size_t entry = 0; entry < powers.size(); ++entry) {
    const Emitter& emitter = m_emitters[m_emitterOfEntry[entry]];
    const std::uint32_t element = static_cast<std::uint32_t>(entry) - emitter.first;
    powers[entry] *= std::visit([&](const auto& kind) { return kind.powerExtent(element); }, emitter.kind);
  }
  m_choice = AliasTable(powers);
}

/// What the radiance (point and spot lights: intensity) of each entry is worth.
std::vector<double> LightTable::worths(const Scene& scene) const {
  spectral::DomainSamples luminance = spectral::DomainSamples::Zero();
  const auto curves = scene.film.observer.onDomain();
  luminance = (curves * scene.film.luminanceOfResponse).cwiseAbs();
  luminance /= std::max(luminance.sum(), std::numeric_limits<double>::min());
  std::vector<double> ofSpectrum;
  for (SpectrumId id = 0; id < scene.spectra.size(); ++id) {
    ofSpectrum.push_back(worth(scene, id, luminance));
  }
  std::vector<double> result(m_emitterOfEntry.size());
  for (std::size_t entry = 0; entry < result.size(); ++entry) {
    const Emitter& emitter = m_emitters[m_emitterOfEntry[entry]];
    if (emitter.glow.picture == nullptr) {
      result[entry] = ofSpectrum[emitter.glow.spectrum];
      continue;
    }
    const std::size_t emitters = emitter.glow.picture->emitters.size();
    const std::size_t element = entry - emitter.first;
    for (std::size_t k = 0; k < emitters; ++k) {
      result[entry] += static_cast<double>(emitter.glow.picture->drives[element * emitters + k]) *
                       ofSpectrum[emitter.glow.picture->emitters[k]];
    }
  }
  return result;
}

std::vector<LightBounds> LightTable::bounds(const Scene& scene) const {
  const std::vector<double> worth = worths(scene);
  std::vector<LightBounds> result;
  result.reserve(worth.size());
  for (std::size_t entry = 0; entry < worth.size(); ++entry) {
    const Emitter& emitter = m_emitters[m_emitterOfEntry[entry]];
    const std::uint32_t element = static_cast<std::uint32_t>(entry) - emitter.first;
    result.push_back(std::visit([&](const auto& kind) { return kind.bounds(element); }, emitter.kind));
    result.back().intensity *= static_cast<float>(worth[entry]);
  }
  return result;
}

float LightTable::geometry(const LightPoint& point, const Vec3& from, const Vec3& normal) const {
  const Emitter& emitter = m_emitters[m_emitterOfEntry[point.entry]];
  const std::uint32_t element = point.entry - emitter.first;
  return std::visit(
      [&](const auto& kind) {
        if constexpr (requires { kind.areaPoint(element, point.u, point.v); }) {
          return geometryOfArea(kind.areaPoint(element, point.u, point.v), from, normal);
        } else {
          const LightSample light = kind.located(element, point.u, point.v, from);
          return light.pdf > 0.0F ? std::max(0.0F, light.direction.dot(normal)) * light.scale / light.pdf : 0.0F;
        }
      },
      emitter.kind);
}

std::optional<AreaPoint> LightTable::areaPoint(const LightPoint& point) const {
  const Emitter& emitter = m_emitters[m_emitterOfEntry[point.entry]];
  const std::uint32_t element = point.entry - emitter.first;
  return std::visit(
      [&](const auto& kind) -> std::optional<AreaPoint> {
        if constexpr (requires { kind.areaPoint(element, point.u, point.v); }) {
          return kind.areaPoint(element, point.u, point.v);
        } else {
          return std::nullopt;
        }
      },
      emitter.kind);
}

const RectangleEmitter* LightTable::onlyRectangle() const {
  if (entryCount() != 1) {
    return nullptr;
  }
  const auto* rectangle = std::get_if<RectangleEmitter>(&m_emitters.front().kind);
  return rectangle != nullptr && rectangle->picture == nullptr ? rectangle : nullptr;
}

LightSample LightTable::located(const LightPoint& point, const Vec3& from) const {
  const std::uint32_t index = m_emitterOfEntry[point.entry];
  const Emitter& emitter = m_emitters[index];
  const std::uint32_t element = point.entry - emitter.first;
  LightSample sample = std::visit(
      [&](const auto& kind) {
        if constexpr (requires { kind.areaPoint(element, point.u, point.v); }) {
          return seenOnArea(kind.areaPoint(element, point.u, point.v), from);
        } else {
          return kind.located(element, point.u, point.v, from);
        }
      },
      emitter.kind);
  sample.emitter = index;
  sample.element = element;
  return sample;
}

std::uint32_t LightTable::elementOf(const Hit& hit) const {
  return std::visit([&](const auto& kind) { return kind.elementOf(hit); }, m_emitters[hit.emitter].kind);
}

float LightTable::locatedPdf(const Hit& hit, const Vec3& from, const Vec3& direction) const {
  return std::visit([&](const auto& kind) { return kind.pdf(hit, from, direction); }, m_emitters[hit.emitter].kind);
}

std::uint32_t LightTable::environmentElement(const Vec3& direction) const {
  return environment().elementTowards(direction);
}

float LightTable::locatedEnvironmentPdf(const Vec3& direction) const {
  return environment().at(environmentElement(direction), 0.0F, 0.0F).pdf;
}

}  // namespace metamer::spectral_ref
