// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>

#include "metamer/spectral/input_error.h"
#include "metamer/spectral/pending_file.h"
#include "stage/chart_picture.h"
#include "stage/fixture_options.h"
#include "stage/match_report.h"
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

stage::MatchRequest requestOf(const MatchOptions& options, std::size_t emitterCount) {
  return {options.method, options.weights, limitsOf(options.limits, emitterCount), "--charts"};
}

stage::MatchOutcome matchSpectra(const MatchOptions& options, const spectral::DataLibrary& library) {
  const stage::Fixture fixture = stage::readFixture(options.emitters, library);
  const spectral::Spectrum target = library.illuminant(options.target);
  const spectral::Observer observer = library.observer(options.observer);
  stage::MatchOutcome outcome = stage::matchSpectra(requestOf(options, fixture.names.size()), fixture, target, observer,
                                                    library.reflectances(options.reflectances).samples,
                                                    xyzFromResponseUnder(target, observer, library));
  outcome.reflectances = options.reflectances;
  return outcome;
}

stage::MatchOutcome matchCharts(const MatchOptions& options, const spectral::DataLibrary& library) {
  if (stage::matchMethodFromName(options.method) == stage::MatchMethod::Spectral) {
    throw InputError("--method", "method", options.method, "needs spectra: give --emitters; charts do for mim and mrm");
  }
  const ChartReader reader({}, library, {});
  std::vector<std::string> notes;
  std::vector<stage::ChartTable> charts;
  std::vector<std::string> emitters;
  for (const std::string& file : options.charts) {
    charts.push_back(reader.read({file, {}}, notes));
    emitters.push_back(std::filesystem::path(file).stem().string());
  }
  const stage::ChartTable target = reader.read({options.target, {}}, notes);
  stage::MatchOutcome outcome = stage::matchCharts(requestOf(options, charts.size()), charts, target,
                                                   library.colourSpace(options.colourSpace).linear.xyzFromRgb());
  outcome.emitters = emitters;
  outcome.models.assign(emitters.size(), false);
  outcome.notes = notes;
  outcome.observer = "camera RGB taken for " + options.colourSpace;
  outcome.reflectances = "charts";
  return outcome;
}

void match(const MatchOptions& options) {
  for (const std::string& file : {options.output, options.report, options.figure}) {
    spectral::requireWritable(file);
  }
  const auto library = spectral::DataLibrary::openDefault();
  stage::MatchOutcome outcome = options.charts.empty() ? matchSpectra(options, library) : matchCharts(options, library);
  outcome.target = options.target;
  outcome.method = options.method;
  if (stage::matchMethodFromName(options.method) == stage::MatchMethod::MetamericReflectance) {
    outcome.weights = options.weights;
  }
  stage::addReachNotes(outcome);
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
