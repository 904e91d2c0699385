// SPDX-License-Identifier: Apache-2.0
#include "scenes/measured_surfaces.h"

#include <algorithm>
#include <array>

namespace metamer::sip {

namespace {

constexpr const char* kModelSkins = "model skins";
constexpr const char* kVirtualSkins = "virtual skins";
constexpr double kTwinRms = 0.02;
constexpr double kTwinSquares = kTwinRms * kTwinRms * spectral::kDomainSize;

/// A few wavelengths of a sample: most samples differ by enough in these, and theirs lie together in memory.
constexpr int kFewStep = 40;
using Few = std::array<double, (spectral::kDomainSize + kFewStep - 1) / kFewStep>;

Few fewOf(const spectral::DomainSamples& sample) {
  Few few{};
  for (std::size_t k = 0; k < few.size(); ++k) {
    few[k] = sample[static_cast<Eigen::Index>(k) * kFewStep];
  }
  return few;
}

bool mayBeTwins(const Few& one, const Few& other) {
  double squares = 0.0;
  for (std::size_t k = 0; k < one.size(); ++k) {
    squares += (one[k] - other[k]) * (one[k] - other[k]);
  }
  return squares < kTwinSquares;
}

bool areTwins(const spectral::DomainSamples& one, const spectral::DomainSamples& other) {
  return (one - other).squaredNorm() < kTwinSquares;
}

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
  const Few few = fewOf(sample);
  return std::any_of(samples.begin(), samples.end(), [&](const spectral::DomainSamples& other) {
    return mayBeTwins(fewOf(other), few) && areTwins(other, sample);
  });
}

std::vector<spectral::DomainSamples> measuredSurfaces(const spectral::DataLibrary& library) {
  std::vector<spectral::DomainSamples> surfaces;
  std::vector<Few> fewOfEach;
  for (const std::string& name : library.reflectanceSetNames()) {
    if (name == kModelSkins || name == kVirtualSkins) {
      continue;
    }
    for (const spectral::DomainSamples& sample : onDomain(library.reflectances(name))) {
      const Few few = fewOf(sample);
      bool isNew = true;
      for (std::size_t i = 0; i < surfaces.size() && isNew; ++i) {
        isNew = !(mayBeTwins(fewOfEach[i], few) && areTwins(surfaces[i], sample));
      }
      if (isNew) {
        surfaces.push_back(sample);
        fewOfEach.push_back(few);
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
