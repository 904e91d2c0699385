// SPDX-License-Identifier: Apache-2.0
#include "metamer/stage/fixture.h"

#include "metamer/stage/emitter_model.h"

namespace metamer::stage {

Fixture readFixture(const std::vector<std::string>& texts, const spectral::DataLibrary& library) {
  Fixture fixture;
  for (const std::string& text : texts) {
    for (Emitter& emitter : emittersFrom(text, library)) {
      fixture.names.push_back(emitter.spectrum.name());
      fixture.models.push_back(emitter.isModel);
      if (emitter.isModel) {
        fixture.notes.push_back("emitter '" + fixture.names.back() + "' is a model, not a measurement");
      }
      fixture.spectra.push_back(std::move(emitter.spectrum));
    }
  }
  fixture.columns.resize(spectral::kDomainSize, static_cast<Eigen::Index>(fixture.spectra.size()));
  for (std::size_t k = 0; k < fixture.spectra.size(); ++k) {
    fixture.columns.col(static_cast<Eigen::Index>(k)) = fixture.spectra[k].onDomain();
  }
  return fixture;
}

spectral::Spectrum mixedLight(const spectral::DomainSamples& power) {
  std::vector<double> wavelengthsNm;
  for (int nm = spectral::kDomainStartNm; nm <= spectral::kDomainEndNm; ++nm) {
    wavelengthsNm.push_back(nm);
  }
  return {"mixed light", spectral::SpectralQuantity::SpectralPowerDistribution, wavelengthsNm,
          std::vector<double>(power.begin(), power.end())};
}

}  // namespace metamer::stage
