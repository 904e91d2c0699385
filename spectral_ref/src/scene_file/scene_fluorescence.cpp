// SPDX-License-Identifier: Apache-2.0
#include "scene_file/scene_fluorescence.h"

#include "metamer/spectral/fluorescence.h"
#include "metamer/spectral/path_text.h"

namespace metamer::spectral_ref {
namespace {

using spectral::ExcitationSamples;
using spectral::SpectralQuantity;
using spectral::Spectrum;
using Use = SceneSpectra::Use;

/// 300, 301, ... 780 nm.
std::vector<double> excitationNm() {
  std::vector<double> nm;
  for (int i = 0; i < spectral::kExcitationSize; ++i) {
    nm.push_back(spectral::kExcitationStartNm + i);
  }
  return nm;
}

/// Samples of what a call gives; what it refuses is refused of this section.
template <typename Give>
spectral::FluorescentSamples samplesIn(const YamlMap& section, const Give& give) {
  try {
    return spectral::samplesOf(give());
  } catch (const spectral::InputError& error) {
    throw section.error("", error.what());
  }
}

spectral::FluorescentSamples samplesOfFile(const YamlMap& section, const YamlValue& file, const SceneSpectra& spectra) {
  for (const char* key : {"reflectance", "excitation", "emission", "quantum_yield"}) {
    if (const auto other = section.find(key)) {
      throw other->error("", "stands in the file; leave it out");
    }
  }
  const std::filesystem::path path = spectra.folder() / spectral::pathOf(file.text());
  return samplesIn(section, [&] { return spectral::readFluorescence(path, spectra.library().pictures()); });
}

spectral::FluorescentSamples samplesOfCurves(const YamlMap& section, SceneSpectra& spectra) {
  const char* remedy = "is missing; give reflectance, excitation, emission and quantum_yield, or file";
  const auto curve = [&](const char* key, Use use, SpectralQuantity quantity) {
    const ExcitationSamples samples = spectra.at(spectra.find(section.require(key, remedy), use));
    return Spectrum(key, quantity, excitationNm(), {samples.begin(), samples.end()});
  };
  const double yield = section.require("quantum_yield", remedy).number(0.0, 1.0);
  const Spectrum reflectance = curve("reflectance", Use::Reflectance, SpectralQuantity::Reflectance);
  const Spectrum excitation = curve("excitation", Use::Dye, SpectralQuantity::Sensitivity);
  const Spectrum emission = curve("emission", Use::Dye, SpectralQuantity::Sensitivity);
  return samplesIn(section, [&] {
    return spectral::CompactFluorescence{"surface", reflectance, excitation, emission, yield};
  });
}

}  // namespace

Material readFluorescent(const YamlValue& value, SceneSpectra& spectra, Scene& scene) {
  const YamlMap section(value, {"file", "reflectance", "excitation", "emission", "quantum_yield"});
  const auto file = section.find("file");
  spectral::FluorescentSamples samples =
      file ? samplesOfFile(section, *file, spectra) : samplesOfCurves(section, spectra);
  Material material;
  material.colour = spectra.add(samples.reflectance);
  material.kind = Material::Kind::Diffuse;
  if (samples.perNm.maxCoeff() > 0.0) {
    material.kind = Material::Kind::Fluorescent;
    material.fluorescence = static_cast<std::uint32_t>(scene.fluorescences.size());
    scene.fluorescences.push_back(std::move(samples));
  }
  return material;
}

}  // namespace metamer::spectral_ref
