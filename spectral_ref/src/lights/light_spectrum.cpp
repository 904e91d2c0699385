// SPDX-License-Identifier: Apache-2.0
#include "lights/light_spectrum.h"

#include <set>

namespace metamer::spectral_ref {
namespace {

std::set<SpectrumId> emittedSpectra(const Scene& scene) {
  std::set<SpectrumId> spectra;
  const auto addSurfaces = [&](const auto& shapes) {
    for (const auto& shape : shapes) {
      if (shape.surface.emission) {
        spectra.insert(shape.surface.emission->spectrum);
      }
    }
  };
  addSurfaces(scene.rectangles);
  addSurfaces(scene.spheres);
  addSurfaces(scene.meshes);
  for (const EmitterPicture& picture : scene.pictures) {
    spectra.insert(picture.emitters.begin(), picture.emitters.end());
  }
  for (const PointLight& light : scene.points) {
    spectra.insert(light.intensity);
  }
  for (const SpotLight& light : scene.spots) {
    spectra.insert(light.intensity);
  }
  return spectra;
}

}  // namespace

spectral::DomainSamples worthOfLights(const Scene& scene) {
  const auto curves = scene.film.observer.onDomain();
  const spectral::DomainSamples worth =
      (curves * scene.film.luminanceOfResponse).cwiseAbs() + curves.cwiseAbs().rowwise().sum();
  spectral::DomainSamples sum = spectral::DomainSamples::Zero();
  for (const SpectrumId id : emittedSpectra(scene)) {
    spectral::DomainSamples light = scene.spectra[id];
    for (const spectral::FluorescentSamples& surface : scene.fluorescences) {
      light += (surface.perNm * scene.whole(id)).tail<spectral::kDomainSize>();
    }
    const spectral::DomainSamples seen = light.cwiseProduct(worth);
    const double total = seen.sum();
    if (total > 0) {
      sum += seen / total;
    }
  }
  return sum;
}

spectral::ExcitationSamples excitingLight(const Scene& scene) {
  spectral::ExcitationSamples mean = spectral::ExcitationSamples::Zero();
  const std::set<SpectrumId> lights = emittedSpectra(scene);
  for (const SpectrumId id : lights) {
    const spectral::ExcitationSamples light = scene.whole(id);
    if (const double total = light.sum(); total > 0) {
      mean += light / (total * static_cast<double>(lights.size()));
    }
  }
  return mean;
}

}  // namespace metamer::spectral_ref
