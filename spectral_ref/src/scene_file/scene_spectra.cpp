// SPDX-License-Identifier: Apache-2.0
#include "scene_file/scene_spectra.h"

#include <algorithm>
#include <cmath>

#include "metamer/spectral/near_names.h"
#include "metamer/spectral/optical_constants.h"
#include "metamer/spectral/path_text.h"
#include "metamer/spectral/spectral_files.h"
#include "metamer/spectral/spectrum.h"
#include "metamer/spectral/uplift.h"

namespace metamer::spectral_ref {
namespace {

using spectral::ExcitationSamples;
using spectral::InputError;
using spectral::onExcitation;
using spectral::SpectralQuantity;
using spectral::Spectrum;

using Use = SceneSpectra::Use;

SpectralQuantity quantityOf(Use use) {
  switch (use) {
    case Use::Emission:
      return SpectralQuantity::SpectralPowerDistribution;
    case Use::Transmittance:
      return SpectralQuantity::Transmittance;
    case Use::Dye:
      return SpectralQuantity::Sensitivity;
    case Use::Reflectance:
    case Use::Refraction:  // holds its end values, as a reflectance does
    case Use::Extinction:
      break;
  }
  return SpectralQuantity::Reflectance;
}

/// The reflectance that a published uplift gives a colour: linear Rec.709, white the perfect reflector under D65.
ExcitationSamples uplifted(const YamlValue& rgb, const std::optional<YamlValue>& method,
                           const spectral::DataLibrary& library) {
  /// What curves miss 0 and 1 by for black and white; all else is the method's own.
  constexpr double kRounding = 2e-3;
  const std::vector<double> colour = rgb.numbers(0.0, 1.0);
  if (colour.size() != 3) {
    throw rgb.error("", "must be three numbers from 0 to 1, linear Rec.709");
  }
  const auto uplift = lookUp(method.value_or(rgb), [&] {
    return spectral::makeUplift(spectral::upliftMethodNamed(method ? method->text() : "jakob"), library);
  });
  std::vector<double> values(uplift->wavelengthsNm().size());
  uplift->spectra(colour, values);
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  if (*least < -kRounding || *most > 1 + kRounding) {
    throw rgb.error("", "gets a spectrum from " + std::to_string(*least) + " to " + std::to_string(*most) +
                            ", which no surface has; use 'uplift: jakob'");
  }
  for (double& value : values) {
    value = std::clamp(value, 0.0, 1.0);
  }
  return onExcitation(Spectrum(rgb.field(), SpectralQuantity::Reflectance, uplift->wavelengthsNm(), values));
}

/// Radiance beyond this, or a sum of many such, is beyond single precision's comfort.
constexpr double kLargestScale = 1e12;

}  // namespace

SceneSpectra::SceneSpectra(const std::optional<YamlValue>& section, Scene& scene, const spectral::DataLibrary& library,
                           std::filesystem::path folder)
    : m_scene(scene), m_library(library), m_folder(std::move(folder)) {
  if (section) {
    const YamlMap names(*section, {});
    for (const std::string& name : names.keys()) {
      m_definitions.emplace(name, *names.find(name));
    }
  }
}

SpectrumId SceneSpectra::add(const ExcitationSamples& samples) {
  m_scene.spectra.emplace_back(samples.tail<spectral::kDomainSize>());
  m_scene.ultraviolet.emplace_back(samples.head<spectral::kDomainInExcitation>());
  return static_cast<SpectrumId>(m_scene.spectra.size() - 1);
}

SpectrumId SceneSpectra::add(const spectral::DomainSamples& samples) {
  ExcitationSamples all = ExcitationSamples::Zero();
  all.tail<spectral::kDomainSize>() = samples;
  return add(all);
}

SpectrumId SceneSpectra::find(const YamlValue& value, Use use) {
  const std::string name = value.text();
  const auto known = m_resolved.find({name, use});
  if (known != m_resolved.end()) {
    return known->second;
  }
  const auto definition = m_definitions.find(name);
  ExcitationSamples samples;
  if (definition != m_definitions.end()) {
    samples = read(definition->second, use);
  } else if (value.isNumber()) {
    samples.setConstant(value.number(0.0, kLargestScale));
  } else {
    samples = fromLibrary(value, name, use);
  }
  auto ultraviolet = samples.head<spectral::kDomainInExcitation>();
  if (use == Use::Reflectance || use == Use::Transmittance) {
    if (samples.tail<spectral::kDomainSize>().maxCoeff() > 1.0) {
      throw value.error("is above 1 somewhere; a surface cannot give back more light than it gets");
    }
    // Read where surfaces fluoresce alone: not judged.
    ultraviolet = ultraviolet.cwiseMax(0.0).cwiseMin(1.0);
  } else if (use == Use::Refraction || use == Use::Extinction) {
    ultraviolet.setConstant(samples[spectral::kDomainInExcitation]);
  }
  const SpectrumId id = add(samples);
  m_resolved.emplace(std::pair(name, use), id);
  return id;
}

ExcitationSamples SceneSpectra::fromLibrary(const YamlValue& value, const std::string& name, Use use) const {
  try {
    if (use == Use::Emission) {
      return onExcitation(m_library.illuminant(name, m_folder));
    }
    if (use == Use::Transmittance) {
      return onExcitation(m_library.filter(name, m_folder));
    }
  } catch (const InputError& error) {
    throw value.error("", std::string("no such name under 'spectra:'; ") + error.what());
  }
  std::vector<std::string> names;
  for (const auto& [defined, definition] : m_definitions) {
    names.push_back(defined);
  }
  const auto near = spectral::nearNames(name, names, 2);
  throw value.error("no such name under 'spectra:'" + (near.empty() ? "" : "; did you mean '" + near.front() + "'?"));
}

ExcitationSamples SceneSpectra::read(const YamlValue& definition, Use use) const {
  const YamlMap section(definition, {"illuminant", "filter", "density", "reflectance", "sample", "wavelengths",
                                     "values", "constant", "file", "rgb", "uplift", "scale"});
  const auto scaleValue = section.find("scale");
  const double scale = scaleValue ? scaleValue->number(0.0, kLargestScale) : 1.0;
  const auto refuse = [&](bool wrong, const char* what) {
    if (wrong) {
      throw section.error("", std::string(what) + " and is used as something else; define another spectrum for that");
    }
  };
  int kinds = 0;
  for (const char* kind : {"illuminant", "filter", "reflectance", "wavelengths", "constant", "rgb", "file"}) {
    kinds += section.find(kind) ? 1 : 0;
  }
  if (kinds != 1) {
    throw section.error(
        "", "must have one of illuminant, filter, reflectance, wavelengths (with values), constant, rgb, file");
  }
  ExcitationSamples samples;
  if (const auto name = section.find("illuminant")) {
    refuse(use != Use::Emission, "is an illuminant");
    samples = lookUp(*name, [&] { return onExcitation(m_library.illuminant(name->text(), m_folder)); });
  } else if (const auto filter = section.find("filter")) {
    refuse(use != Use::Transmittance, "is a filter");
    samples = lookUp(*filter, [&] { return onExcitation(m_library.filter(filter->text(), m_folder)); });
    const auto density = section.find("density");
    samples = samples.array().pow(density ? density->number(0.0, 100.0) : 1.0);
  } else if (const auto set = section.find("reflectance")) {
    refuse(use != Use::Reflectance, "is a reflectance");
    const std::string wanted = section.require("sample", "is missing; name a sample of the set").text();
    const auto reflectances = lookUp(*set, [&] { return m_library.reflectances(set->text(), m_folder); });
    std::vector<std::string> names;
    for (const Spectrum& sample : reflectances.samples) {
      if (sample.name() == wanted) {
        return onExcitation(sample) * scale;
      }
      names.push_back(sample.name());
    }
    const auto near = spectral::nearNames(wanted, names, 3);
    throw section.find("sample")->error("is not in the set" +
                                        (near.empty() ? std::string() : "; near names: " + near.front()));
  } else if (const auto wavelengths = section.find("wavelengths")) {
    const auto values = section.require("values", "is missing; one value a wavelength");
    samples = lookUp(*wavelengths, [&] {
      return onExcitation(Spectrum(section.field(), quantityOf(use), wavelengths->numbers(), values.numbers()));
    });
  } else if (const auto constant = section.find("constant")) {
    samples.setConstant(constant->number(0.0, kLargestScale));
  } else if (const auto rgb = section.find("rgb")) {
    refuse(use != Use::Reflectance && use != Use::Transmittance, "is the colour of a surface");
    samples = uplifted(*rgb, section.find("uplift"), m_library);
  } else {
    const auto file = section.find("file");
    samples = lookUp(*file, [&] {
      // A file without folder would be taken for a name.
      const std::string relative = spectral::utf8(m_folder / spectral::pathOf(file->text()));
      const std::string path = relative.find('/') == std::string::npos ? "./" + relative : relative;
      switch (use) {
        case Use::Emission:
          return onExcitation(m_library.illuminant(path));
        case Use::Transmittance:
          return onExcitation(m_library.filter(path));
        case Use::Refraction:
          return onExcitation(
              spectral::readOpticalConstant(spectral::pathOf(path), spectral::OpticalConstant::Refraction));
        case Use::Extinction:
          return onExcitation(
              spectral::readOpticalConstant(spectral::pathOf(path), spectral::OpticalConstant::Extinction));
        case Use::Dye:
          return onExcitation(
              spectral::readSpectralFile(spectral::pathOf(path), SpectralQuantity::Sensitivity, m_library.pictures())
                  .front());
        case Use::Reflectance:
          break;
      }
      return onExcitation(m_library.reflectances(path).samples.front());
    });
  }
  return samples * scale;
}

std::vector<SpectrumId> SceneSpectra::set(const YamlValue& value) {
  const auto reflectances = lookUp(value, [&] { return m_library.reflectances(value.text(), m_folder); });
  std::vector<SpectrumId> ids;
  for (const Spectrum& sample : reflectances.samples) {
    ids.push_back(add(ExcitationSamples(onExcitation(sample).cwiseMax(0.0).cwiseMin(1.0))));
  }
  return ids;
}

}  // namespace metamer::spectral_ref
