// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>

#include "metamer/spectral/input_error.h"
#include "metamer/spectral/pending_file.h"
#include "metamer/spectral/spectral_similarity_index.h"
#include "metamer/stage/emitter_match.h"
#include "stage/chart_picture.h"
#include "stage/fixture.h"
#include "stage/match_outcome.h"
#include "stage/stage_capture.h"
#include "stage/stage_commands.h"
#include "stage/stage_json.h"

namespace metamer::lutgen {
namespace {

using spectral::InputError;

struct MatchOptions {
  std::string target;
  std::vector<std::string> emitters;
  std::vector<std::string> charts;
  std::string colourSpace = "ACEScg";
  std::string report;
  std::string figure;
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

Eigen::Matrix3Xd chartUnder(const spectral::DomainSamples& light, const stage::ObserverCurves& curves,
                            const Materials& materials) {
  Eigen::Matrix3Xd chart(3, static_cast<Eigen::Index>(materials.samples.size()));
  for (std::size_t i = 0; i < materials.samples.size(); ++i) {
    chart.col(static_cast<Eigen::Index>(i)) = curves.transpose() * materials.samples[i].cwiseProduct(light);
  }
  return chart;
}

stage::MatchWeights weightsOf(const MatchOptions& options) {
  return options.weights == "relative" ? stage::MatchWeights::Relative : stage::MatchWeights::Absolute;
}

bool isPerceptual(stage::MatchMethod method, const MatchOptions& options) {
  return method == stage::MatchMethod::MetamericReflectance && options.weights == "perceptual";
}

stage::MatchSystem systemOf(stage::MatchMethod method, const MatchOptions& options, const Fixture& fixture,
                            const spectral::DomainSamples& target, const stage::ObserverCurves& curves,
                            const Materials& materials) {
  switch (method) {
    case stage::MatchMethod::Spectral:
      return stage::spectralSystem(fixture.columns, target);
    case stage::MatchMethod::MetamericIlluminant:
      return stage::illuminantSystem(fixture.columns, target, curves);
    case stage::MatchMethod::MetamericReflectance:
      break;
  }
  return stage::reflectanceSystem(fixture.columns, target, curves, materials.samples, weightsOf(options));
}

MatchOutcome matchSpectra(const MatchOptions& options, const spectral::DataLibrary& library) {
  const Fixture fixture = readFixture(options.emitters, library);
  const spectral::Spectrum target = library.illuminant(options.target);
  const spectral::Observer observer = library.observer(options.observer);
  const Materials materials = materialsOf(library.reflectances(options.reflectances));
  const stage::ObserverCurves curves = observer.onDomain();
  const spectral::DomainSamples light = target.onDomain();
  MatchOutcome outcome;
  outcome.observer = observer.name;
  outcome.reflectances = options.reflectances;
  outcome.emitters = fixture.names;
  outcome.models = fixture.models;
  outcome.notes = fixture.notes;
  outcome.xyzFromResponse = xyzFromResponseUnder(target, observer, library);
  outcome.white = curves.transpose() * light;
  const stage::MatchMethod method = stage::matchMethodFromName(options.method);
  const stage::MatchSystem system = systemOf(method, options, fixture, light, curves, materials);
  const stage::DriveLimits limits = limitsOf(options.limits, fixture.names.size());
  if (isPerceptual(method, options)) {
    const auto illuminant = stage::solveMatch(stage::illuminantSystem(fixture.columns, light, curves), limits);
    const Eigen::Vector3d white = outcome.white / outcome.white[1];
    outcome.match = stage::solvePerceptualMatch(system, {outcome.xyzFromResponse, white}, {illuminant.drives}, limits);
  } else {
    outcome.match = stage::solveMatch(system, limits);
  }
  const spectral::DomainSamples mixed = fixture.columns * outcome.match.drives;
  outcome.patches = materials.names;
  outcome.wanted = chartUnder(light, curves, materials);
  outcome.made = chartUnder(mixed, curves, materials);
  if (mixed.maxCoeff() > 0) {
    outcome.spectralSimilarity = spectral::spectralSimilarityIndex(lightOf(mixed), target);
  }
  return outcome;
}

/// From pictures alone (section 2.5.2): the chart under each emitter, and under the target.
MatchOutcome matchCharts(const MatchOptions& options, const spectral::DataLibrary& library) {
  const stage::MatchMethod method = stage::matchMethodFromName(options.method);
  if (method == stage::MatchMethod::Spectral) {
    throw InputError("--method", "method", options.method, "needs spectra: give --emitters; charts do for mim and mrm");
  }
  const ChartReader reader({}, library, {});
  MatchOutcome outcome;
  std::vector<stage::ChartTable> tables;
  for (const std::string& file : options.charts) {
    tables.push_back(reader.read({file, {}}, outcome.notes));
    outcome.emitters.push_back(std::filesystem::path(file).stem().string());
    outcome.models.push_back(false);
  }
  tables.push_back(reader.read({options.target, {}}, outcome.notes));
  auto aligned = stage::alignCharts(tables, std::nullopt);
  if (aligned.names.empty()) {
    throw InputError("--charts", "charts", "", "no patch is in all charts with values that can be used");
  }
  outcome.excluded = aligned.excluded;
  outcome.patches = aligned.names;
  outcome.wanted = aligned.charts.back();
  aligned.charts.pop_back();
  Eigen::Index brightest = 0;
  outcome.wanted.row(1).maxCoeff(&brightest);
  const int white = patchNamed(aligned.names, "white");
  const Eigen::Index whitePatch = white >= 0 ? white : brightest;
  outcome.xyzFromResponse = library.colourSpace(options.colourSpace).linear.xyzFromRgb();
  outcome.white = outcome.wanted.col(whitePatch);
  const stage::DriveLimits limits = limitsOf(options.limits, options.charts.size());
  const auto illuminantMatch = [&] {
    std::vector<Eigen::Matrix3Xd> whites;
    for (const Eigen::Matrix3Xd& chart : aligned.charts) {
      whites.emplace_back(chart.col(whitePatch));
    }
    return stage::solveMatch(stage::chartSystem(whites, outcome.wanted.col(whitePatch)), limits);
  };
  if (method == stage::MatchMethod::MetamericIlluminant) {
    outcome.match = illuminantMatch();
  } else {
    const auto system = stage::chartSystem(aligned.charts, outcome.wanted, weightsOf(options));
    outcome.match = isPerceptual(method, options)
                        ? stage::solvePerceptualMatch(system, {outcome.xyzFromResponse, outcome.white},
                                                      {illuminantMatch().drives}, limits)
                        : stage::solveMatch(system, limits);
  }
  outcome.made = Eigen::Matrix3Xd::Zero(3, outcome.wanted.cols());
  for (std::size_t k = 0; k < aligned.charts.size(); ++k) {
    outcome.made += outcome.match.drives[static_cast<Eigen::Index>(k)] * aligned.charts[k];
  }
  outcome.observer = "camera RGB taken for " + options.colourSpace;
  outcome.reflectances = "charts";
  return outcome;
}

void match(const MatchOptions& options) {
  const auto library = spectral::DataLibrary::openDefault();
  MatchOutcome outcome = options.charts.empty() ? matchSpectra(options, library) : matchCharts(options, library);
  outcome.target = options.target;
  outcome.method = options.method;
  if (stage::matchMethodFromName(options.method) == stage::MatchMethod::MetamericReflectance) {
    outcome.weights = options.weights;
  }
  addReachNotes(outcome);
  if (!options.figure.empty()) {
    writeFigure(outcome, library, options.figure);
  }
  if (!options.report.empty()) {
    spectral::writeWholeFile(options.report, reportOf(outcome, relativeTo(options.report, options.figure)));
  }
  writeJson(options.output, toJson(outcome));
  std::cout << summaryOf(outcome);
}

}  // namespace

void addStageMatch(CLI::App& stage) {
  CLI::App* command = stage.add_subcommand("match", "Drives of several emitters that reproduce a light");
  const auto options = std::make_shared<MatchOptions>();
  command->add_option("--target", options->target, "Light to reproduce: NAME or FILE; with --charts, its chart (CSV)")
      ->required();
  CLI::App* emitters = command->add_option_group("emitters", "Spectra, or charts");
  emitters
      ->add_option("--emitters", options->emitters,
                   "Spectra of the emitters at a drive of 1: FILE (one a column), NAME, led:PEAK:WIDTH or "
                   "phosphor:PUMP:PUMP_WIDTH:PEAK:WIDTH:PUMP_SHARE")
      ->expected(1, 64);
  emitters
      ->add_option("--charts", options->charts,
                   "In place of spectra: the chart under each emitter at a drive of 1 as a camera saw it, CSV "
                   "(patch,R,G,B)")
      ->expected(1, 64);
  emitters->require_option(1);
  command->add_option("--method", options->method, "sim: the spectrum; mim: the light's colour; mrm: materials in it")
      ->check(CLI::IsMember({"sim", "mim", "mrm"}, CLI::ignore_case));
  command->add_option("--reflectances", options->reflectances, "Materials: SET or FILE; colorchecker by default");
  command->add_option("--observer", options->observer, "Eye or camera: NAME or FILE; CIE 1931 2 by default");
  command
      ->add_option("--weights", options->weights,
                   "Differences of mrm: absolute (the default), relative to the target's values, or perceptual, by "
                   "mean CIEDE2000")
      ->check(CLI::IsMember({"absolute", "relative", "perceptual"}));
  command->add_option("--colour-space", options->colourSpace,
                      "With --charts: what the camera's RGB is, for colour differences; ACEScg by default");
  command->add_option("--report", options->report, "Markdown to write, for people");
  command->add_option("--figure", options->figure, "PNG to write: the chart as squares in squares");
  addFixtureLimits(*command, options->limits);
  command->add_option("--json", options->output, "JSON to write: drives and residual")->required();
  command->callback([options] { match(*options); });
}

}  // namespace metamer::lutgen
