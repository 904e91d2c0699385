// SPDX-License-Identifier: Apache-2.0
#include "stage/fixture.h"

#include "metamer/sip/pipeline.h"
#include "metamer/spectral/input_error.h"
#include "metamer/stage/emitter_model.h"

namespace metamer::lutgen {
namespace {

constexpr const char* kTrainingSet = "rawtoaces 190";
constexpr const char* kStandardObserver = "CIE 1931 2";

Eigen::VectorXd spread(const std::vector<double>& values, std::size_t count, const char* flag) {
  if (values.size() == 1) {
    return Eigen::VectorXd::Constant(static_cast<Eigen::Index>(count), values.front());
  }
  if (!values.empty() && values.size() != count) {
    throw spectral::InputError(flag, "values", std::to_string(values.size()),
                               "must be one, or one an emitter (" + std::to_string(count) + ")");
  }
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

}  // namespace

Fixture readFixture(const std::vector<std::string>& texts, const spectral::DataLibrary& library) {
  Fixture fixture;
  for (const std::string& text : texts) {
    for (stage::Emitter& emitter : stage::emittersFrom(text, library)) {
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

void addFixtureLimits(CLI::App& command, FixtureLimits& limits) {
  command.add_option("--limits", limits.largest, "Largest drive: one for all, or one an emitter")->expected(1, 64);
  command.add_option("--power", limits.power, "Power at a drive of 1: one for all, or one an emitter")->expected(1, 64);
  command.add_option("--power-budget", limits.budget, "Largest sum of power times drive; needs --power")
      ->check(CLI::PositiveNumber)
      ->needs("--power");
}

stage::DriveLimits limitsOf(const FixtureLimits& limits, std::size_t emitterCount) {
  stage::DriveLimits result;
  result.upper = spread(limits.largest, emitterCount, "--limits");
  if (limits.budget > 0) {
    result.power = spread(limits.power, emitterCount, "--power");
    result.powerBudget = limits.budget;
  }
  return result;
}

Eigen::Matrix3d xyzFromResponseUnder(const spectral::Spectrum& light, const spectral::Observer& observer,
                                     const spectral::DataLibrary& library) {
  std::vector<spectral::DomainSamples> training;
  for (const auto& sample : library.reflectances(kTrainingSet).samples) {
    training.push_back(sample.onDomain());
  }
  return sip::prepare({light, {}, observer}, training, library.observer(kStandardObserver)).xyzFromResponse;
}

spectral::Spectrum lightOf(const spectral::DomainSamples& power) {
  std::vector<double> wavelengthsNm;
  for (int nm = spectral::kDomainStartNm; nm <= spectral::kDomainEndNm; ++nm) {
    wavelengthsNm.push_back(nm);
  }
  return {"mixed light", spectral::SpectralQuantity::SpectralPowerDistribution, wavelengthsNm,
          std::vector<double>(power.begin(), power.end())};
}

}  // namespace metamer::lutgen
