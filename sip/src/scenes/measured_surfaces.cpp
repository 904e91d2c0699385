// SPDX-License-Identifier: Apache-2.0
#include "scenes/measured_surfaces.h"

#include <algorithm>

namespace metamer::sip {

namespace {

constexpr const char* kModelSkins = "model skins";
constexpr const char* kVirtualSkins = "virtual skins";
constexpr double kTwinRms = 0.02;

}  // namespace

std::vector<spectral::DomainSamples> onDomain(const spectral::ReflectanceSet& set) {
  std::vector<spectral::DomainSamples> samples;
  samples.reserve(set.samples.size());
  for (const auto& sample : set.samples) {
    samples.push_back(sample.onDomain());
  }
  return samples;
}

bool hasTwin(const std::vector<spectral::DomainSamples>& samples, const spectral::DomainSamples& sample) {
  constexpr double kTwinSquares = kTwinRms * kTwinRms * spectral::kDomainSize;
  return std::any_of(samples.begin(), samples.end(), [&](const spectral::DomainSamples& other) {
    // Most differ by more in a few wavelengths.
    double some = 0.0;
    for (int k = 0; k < spectral::kDomainSize; k += 40) {
      some += (other[k] - sample[k]) * (other[k] - sample[k]);
    }
    return some < kTwinSquares && (other - sample).squaredNorm() < kTwinSquares;
  });
}

std::vector<spectral::DomainSamples> measuredSurfaces(const spectral::DataLibrary& library) {
  std::vector<spectral::DomainSamples> surfaces;
  for (const std::string& name : library.reflectanceSetNames()) {
    if (name == kModelSkins || name == kVirtualSkins) {
      continue;
    }
    for (const spectral::DomainSamples& sample : onDomain(library.reflectances(name))) {
      if (!hasTwin(surfaces, sample)) {
        surfaces.push_back(sample);
      }
    }
  }
  return surfaces;
}

std::vector<std::string> judgedSetNames(const spectral::DataLibrary& library) {
  std::vector<std::string> names = library.reflectanceSetNames();
  std::erase(names, kVirtualSkins);
  return names;
}

std::vector<spectral::DomainSamples> modelSkins(const spectral::DataLibrary& library) {
  return onDomain(library.reflectances(kModelSkins));
}

std::vector<spectral::DomainSamples> virtualSkins(const spectral::DataLibrary& library) {
  return onDomain(library.reflectances(kVirtualSkins));
}

}  // namespace metamer::sip
