// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <utility>

#include "metamer/spectral/data_library.h"
#include "metamer/spectral/reradiation.h"
#include "metamer/spectral_ref/scene.h"
#include "scene_file/scene_value.h"

namespace metamer::spectral_ref {

/// The `spectra:` of a scene file, resolved when something uses them: what a table means outside its range depends on
/// that.
class SceneSpectra {
 public:
  /// The two parts of a refractive index have a reader of their own (spectral/optical_constants.h). Dye: what excites
  /// it or what it emits, nothing outside its table.
  enum class Use { Emission, Reflectance, Transmittance, Refraction, Extinction, Dye };

  SceneSpectra(const std::optional<YamlValue>& section, Scene& scene, const spectral::DataLibrary& library,
               std::filesystem::path folder);

  /// A number (the same at all wavelengths), a name under `spectra:`, or a name that the data library knows for this
  /// use.
  SpectrumId find(const YamlValue& value, Use use);
  /// Adds a spectrum without a name.
  SpectrumId add(const spectral::ExcitationSamples& samples);
  /// The same of one that is nothing below 380 nm.
  SpectrumId add(const spectral::DomainSamples& samples);
  /// A spectrum that has been added, from 300 nm on.
  spectral::ExcitationSamples at(SpectrumId id) const { return m_scene.whole(id); }
  /// All samples of a reflectance set.
  std::vector<SpectrumId> set(const YamlValue& value);

  const spectral::DataLibrary& library() const { return m_library; }
  const std::filesystem::path& folder() const { return m_folder; }

 private:
  spectral::ExcitationSamples read(const YamlValue& definition, Use use) const;
  spectral::ExcitationSamples fromLibrary(const YamlValue& value, const std::string& name, Use use) const;

  Scene& m_scene;
  const spectral::DataLibrary& m_library;
  std::filesystem::path m_folder;
  std::map<std::string, YamlValue> m_definitions;
  std::map<std::pair<std::string, Use>, SpectrumId> m_resolved;
};

}  // namespace metamer::spectral_ref
