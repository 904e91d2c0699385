// SPDX-License-Identifier: Apache-2.0
#include <iostream>
#include <memory>

#include "fixture.h"
#include "formatted.h"
#include "metamer/sip/chart_difference.h"
#include "metamer/sip/emitter_match.h"
#include "metamer/sip/pipeline.h"
#include "metamer/spectral/input_error.h"
#include "metamer/spectral/spectral_similarity_index.h"
#include "stage_commands.h"
#include "stage_json.h"

namespace metamer::lutgen {
namespace {

using spectral::InputError;

struct MatchOptions {
  std::string target;
  std::vector<std::string> emitters;
  std::string method = "mrm";
  std::string reflectances = "colorchecker";
  std::string observer = "CIE 1931 2";
  std::string weights = "absolute";
  FixtureLimits limits;
  std::string output;
};

struct Materials {
  std::vector<std::string> names;
  std::vector<spectral::DomainSamples> samples;
};

Materials materialsOf(const spectral::ReflectanceSet& set) {
  Materials materials;
  for (const spectral::Spectrum& sample : set.samples) {
    materials.names.push_back(sample.name());
    materials.samples.push_back(sample.onDomain());
  }
  return materials;
}

Eigen::Matrix3Xd chartUnder(const spectral::DomainSamples& light, const sip::ObserverCurves& curves,
                            const Materials& materials) {
  Eigen::Matrix3Xd chart(3, static_cast<Eigen::Index>(materials.samples.size()));
  for (std::size_t i = 0; i < materials.samples.size(); ++i) {
    chart.col(static_cast<Eigen::Index>(i)) = curves.transpose() * materials.samples[i].cwiseProduct(light);
  }
  return chart;
}

sip::MatchSystem systemOf(sip::MatchMethod method, const MatchOptions& options, const Fixture& fixture,
                          const spectral::DomainSamples& target, const sip::ObserverCurves& curves,
                          const Materials& materials) {
  switch (method) {
    case sip::MatchMethod::Spectral:
      return sip::spectralSystem(fixture.columns, target);
    case sip::MatchMethod::MetamericIlluminant:
      return sip::illuminantSystem(fixture.columns, target, curves);
    case sip::MatchMethod::MetamericReflectance:
      break;
  }
  return sip::reflectanceSystem(
      fixture.columns, target, curves, materials.samples,
      options.weights == "relative" ? sip::MatchWeights::Relative : sip::MatchWeights::Absolute);
}

void match(const MatchOptions& options) {
  const auto library = spectral::DataLibrary::openDefault();
  const sip::MatchMethod method = sip::matchMethodFromName(options.method);
  const Fixture fixture = readFixture(options.emitters, library);
  const spectral::Spectrum target = library.illuminant(options.target);
  const spectral::Observer observer = library.observer(options.observer);
  const Materials materials = materialsOf(library.reflectances(options.reflectances));
  const sip::ObserverCurves curves = observer.onDomain();
  const spectral::DomainSamples light = target.onDomain();
  const sip::DriveLimits limits = limitsOf(options.limits, fixture.names.size());

  const sip::EmitterMatch result =
      sip::solveMatch(systemOf(method, options, fixture, light, curves, materials), limits);
  const spectral::DomainSamples mixed = fixture.columns * result.drives;

  const Eigen::Matrix3d xyzFromResponse = xyzFromResponseUnder(target, observer, library);
  const Eigen::Matrix3Xd wanted = chartUnder(light, curves, materials);
  const Eigen::Matrix3Xd made = chartUnder(mixed, curves, materials);
  const auto differences = sip::chartDifferences(made, wanted, xyzFromResponse, curves.transpose() * light);
  const sip::DifferenceSummary summary = sip::summaryOf(differences);

  Json json;
  json["target"] = options.target;
  json["method"] = options.method;
  json["observer"] = observer.name;
  json["reflectances"] = options.reflectances;
  json["emitters"] = fixture.names;
  json["models"] = fixture.models;
  json["drives"] = toJson(result.drives);
  json["residual"] = numberToJson(result.relativeResidual);
  json["residual_norm"] = numberToJson(result.residualNorm);
  json["rank"] = result.rank;
  json["condition"] = numberToJson(result.condition);
  json["SSI"] =
      mixed.maxCoeff() > 0 ? numberToJson(spectral::spectralSimilarityIndex(lightOf(mixed), target)) : Json(nullptr);
  json["dE"] = {{"mean", numberToJson(summary.mean)}, {"max", numberToJson(summary.max)}};
  json["patches"] = Json::array();
  for (std::size_t i = 0; i < differences.size(); ++i) {
    json["patches"].push_back({{"name", materials.names[i]}, {"dE", numberToJson(differences[i])}});
  }
  std::vector<std::string> notes = fixture.notes;
  for (const int dead : result.deadEmitters) {
    notes.push_back("emitter '" + fixture.names[static_cast<std::size_t>(dead)] +
                    "' gives no light to what is matched; its drive is 0");
  }
  if (method == sip::MatchMethod::MetamericIlluminant && result.relativeResidual > 1e-9) {
    notes.push_back("the target's colour is out of the emitters' reach: no mixture within the limits has it");
  }
  json["notes"] = notes;
  writeJson(options.output, json);

  for (std::size_t i = 0; i < fixture.names.size(); ++i) {
    std::cout << formatted("%-30s %.6g\n", fixture.names[i].c_str(), result.drives[static_cast<Eigen::Index>(i)]);
  }
  std::cout << formatted("residual %.6g, CIEDE2000 mean %.2f max %.2f\n", result.relativeResidual, summary.mean,
                         summary.max);
  for (const std::string& note : notes) {
    std::cout << "note: " << note << '\n';
  }
}

}  // namespace

void addStageMatch(CLI::App& stage) {
  CLI::App* command = stage.add_subcommand("match", "Drives of several emitters that reproduce a light");
  const auto options = std::make_shared<MatchOptions>();
  command->add_option("--target", options->target, "Light to reproduce: NAME or FILE")->required();
  command
      ->add_option("--emitters", options->emitters,
                   "Spectra of the emitters at a drive of 1: FILE (one a column), NAME, led:PEAK:WIDTH or "
                   "phosphor:PUMP:PUMP_WIDTH:PEAK:WIDTH:PUMP_SHARE")
      ->required()
      ->expected(1, 64);
  command->add_option("--method", options->method, "sim: the spectrum; mim: the light's colour; mrm: materials in it")
      ->check(CLI::IsMember({"sim", "mim", "mrm"}, CLI::ignore_case));
  command->add_option("--reflectances", options->reflectances, "Materials: SET or FILE; colorchecker by default");
  command->add_option("--observer", options->observer, "Eye or camera: NAME or FILE; CIE 1931 2 by default");
  command->add_option("--weights", options->weights, "Differences of mrm: absolute, or relative to the target's values")
      ->check(CLI::IsMember({"absolute", "relative"}));
  addFixtureLimits(*command, options->limits);
  command->add_option("--json", options->output, "JSON to write: drives and residual")->required();
  command->callback([options] { match(*options); });
}

}  // namespace metamer::lutgen
