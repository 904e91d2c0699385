// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>

#include "library.h"
#include "metamer/spectral/formatted.h"
#include "metamer/spectral/input_error.h"
#include "metamer/spectral/naming_file.h"
#include "metamer/spectral/path_text.h"
#include "metamer/spectral/pending_file.h"
#include "metamer/spectral/spectral_files.h"
#include "metamer/stage/capture_faults.h"
#include "metamer/stage/skin_priority.h"
#include "stage/fixture_options.h"
#include "stage/match_answer.h"
#include "stage/match_report.h"
#include "stage/stage_commands.h"
#include "stage/stage_json.h"
#include "stage_pictures/chart_picture.h"

namespace metamer::lutgen {
namespace {

using spectral::InputError;

/// Of the chart that captures show.
constexpr int kChartColumns = 6;
constexpr int kChartRows = 4;
/// Of captures that say nothing of their own.
constexpr double kAssumedNoise = 0.01;

struct MatchOptions {
  std::vector<std::string> targets;
  std::vector<std::string> filters;
  std::vector<std::string> emitters;
  std::vector<std::string> charts;
  std::string colourSpace = "ACEScg";
  std::string report;
  std::string figure;
  std::string method = "mrm";
  std::string reflectances = "colorchecker";
  std::string observer = "CIE 1931 2";
  std::string weights = "absolute";
  std::string level = "fixed";
  std::string unit;
  std::vector<std::string> ramps;
  std::optional<double> noise;
  int samples = 200;
  std::uint64_t seed = 1;
  bool asCaptured = false;
  std::string priority;
  FixtureLimits limits;
  std::string output;
};

stage::MatchRequest requestOf(const MatchOptions& options, const stage::DriveLimits& limits) {
  return {options.method, options.weights, limits, "--charts",
          options.priority.empty() ? 0 : stage::skinWeightFrom(options.priority)};
}

/// Of each emitter, where ramps were captured.
std::vector<stage::PanelEotf> eotfsOf(const std::vector<std::string>& ramps, std::size_t emitterCount) {
  if (ramps.size() > 1 && ramps.size() != emitterCount) {
    throw InputError("--ramps", "files", std::to_string(ramps.size()),
                     "must be one, or one an emitter (" + std::to_string(emitterCount) + ")");
  }
  std::vector<stage::PanelEotf> eotfs;
  for (const std::string& file : ramps) {
    const std::string text = spectral::readTextFile(spectral::pathOf(file));
    eotfs.push_back(stage::fitEotf(stage::parseDriveSeries(text, file), file));
  }
  eotfs.resize(ramps.empty() ? 0 : emitterCount, eotfs.empty() ? stage::PanelEotf() : eotfs.front());
  return eotfs;
}

/// Solves as the level and the limits ask, and says what they cost.
MatchAnswer answerOf(const MatchOptions& options, const stage::DriveLimits& limits, std::size_t emitterCount,
                     const std::vector<stage::PanelEotf>& eotfs, const stage::MatchWithin& match) {
  MatchAnswer answer;
  if (options.level == "free") {
    stage::LevelMatch found = stage::matchAtFreeLevel(match, limits);
    answer.outcome = std::move(found.outcome);
    answer.level = found.level;
  } else {
    answer.outcome = match(limits);
    answer.limitCost = stage::costOfLimits(answer.outcome, match, limits);
  }
  if (!options.unit.empty()) {
    const auto count = static_cast<Eigen::Index>(emitterCount);
    const Eigen::VectorXd full = limits.upper.size() == 0 ? Eigen::VectorXd::Ones(count) : limits.upper;
    answer.eotfs = eotfs;
    answer.steps = stage::stepsOf(answer.outcome, options.unit, full, answer.level.value_or(1), answer.eotfs);
  }
  return answer;
}

void describe(const MatchOptions& options, const std::string& target, MatchAnswer& answer) {
  answer.outcome.target = target;
  answer.outcome.method = options.method;
  if (stage::matchMethodFromName(options.method) == stage::MatchMethod::MetamericReflectance) {
    answer.outcome.weights = options.weights;
  }
  stage::addReachNotes(answer.outcome);
}

MatchAnswer matchSpectra(const MatchOptions& options, const stage::Fixture& fixture, const spectral::Spectrum& target,
                         const std::vector<stage::PanelEotf>& eotfs, const spectral::DataLibrary& library) {
  const spectral::Observer observer = library.observer(options.observer);
  const auto materials = library.reflectances(options.reflectances).samples;
  const auto skins = stage::virtualSkins(library);
  const Eigen::Matrix3d xyzFromResponse = xyzFromResponseUnder(target, observer, library);
  const std::size_t count = fixture.names.size();
  MatchAnswer answer =
      answerOf(options, limitsOf(options.limits, count), count, eotfs, [&](const stage::DriveLimits& limits) {
        return stage::matchSpectra(requestOf(options, limits), fixture, target, observer, materials, xyzFromResponse,
                                   skins);
      });
  answer.outcome.reflectances = options.reflectances;
  return answer;
}

/// Charts that show a mistake are refused, or noted.
void judgeCharts(const MatchOptions& options, const std::vector<stage::ChartTable>& charts,
                 const spectral::DataLibrary& library, std::vector<std::string>& notes) {
  const spectral::ReflectanceSet set = library.reflectances(options.reflectances);
  for (const stage::ChartTable& chart : charts) {
    const auto aligned = stage::alignCharts({chart}, std::nullopt);
    const auto expectation = stage::expectationOf(aligned.names, set, kChartColumns, kChartRows);
    if (!expectation) {
      continue;
    }
    for (const auto& fault : stage::chartFaults(*expectation, aligned.charts.front(), aligned.names, chart.where)) {
      if (!options.asCaptured) {
        throw InputError(fault.field, "chart", fault.value, fault.remedy);
      }
      notes.push_back("as captured: " + fault.field + " '" + fault.value + "' " + fault.remedy);
    }
  }
}

/// Stated, or from the charts that are known, or assumed.
void addNoise(const MatchOptions& options, const std::vector<stage::ChartTable>& charts,
              const spectral::DataLibrary& library, stage::CaptureNoise& noise, std::string& noiseIs) {
  const auto aligned = stage::alignCharts(charts, std::nullopt);
  const auto expectation =
      stage::expectationOf(aligned.names, library.reflectances(options.reflectances), kChartColumns, kChartRows);
  noiseIs = options.noise ? "stated" : expectation ? "estimated from the charts" : "assumed";
  noise.relative = options.noise ? *options.noise
                   : expectation ? stage::estimatedNoise(*expectation, aligned.charts)
                                 : kAssumedNoise;
}

MatchAnswer matchCharts(const MatchOptions& options, const std::vector<stage::PanelEotf>& eotfs,
                        const spectral::DataLibrary& library) {
  if (stage::matchMethodFromName(options.method) == stage::MatchMethod::Spectral) {
    throw InputError("--method", "method", options.method, "needs spectra: give --emitters; charts do for mim and mrm");
  }
  if (options.targets.size() > 1 || !options.filters.empty()) {
    throw InputError("--charts", "target", options.targets.front(),
                     "must be one chart without filters; lists of lights and gels need --emitters");
  }
  const ChartReader reader({}, library, {});
  std::vector<std::string> notes;
  std::vector<stage::ChartTable> charts;
  std::vector<std::string> emitters;
  for (const std::string& file : options.charts) {
    charts.push_back(reader.read({spectral::pathOf(file), {}}, notes));
    emitters.push_back(spectral::utf8(spectral::pathOf(file).stem()));
  }
  const stage::ChartTable target = reader.read({spectral::pathOf(options.targets.front()), {}}, notes);
  std::vector<stage::ChartTable> all = charts;
  all.push_back(target);
  judgeCharts(options, all, library, notes);
  const Eigen::Matrix3d xyzFromCamera = library.colourSpace(options.colourSpace).linear.xyzFromRgb();
  const stage::DriveLimits limits = limitsOf(options.limits, charts.size());
  // What errors and notes call the emitters.
  const auto named = [&](stage::MatchOutcome outcome) {
    outcome.emitters = emitters;
    return outcome;
  };
  MatchAnswer answer = answerOf(options, limits, charts.size(), eotfs, [&](const stage::DriveLimits& within) {
    return named(stage::matchCharts(requestOf(options, within), charts, target, xyzFromCamera));
  });
  if (options.samples > 0) {
    stage::IntervalOptions draws;
    std::string noiseIs;
    addNoise(options, all, library, draws.noise, noiseIs);
    draws.samples = options.samples;
    draws.seed = options.seed;
    answer.intervals = stage::matchIntervals(
        charts, target,
        [&](std::vector<stage::ChartTable> drawn, const stage::ChartTable& there) {
          const auto within = [&](const stage::DriveLimits& bounds) {
            return stage::matchCharts(requestOf(options, bounds), drawn, there, xyzFromCamera);
          };
          return options.level == "free" ? stage::matchAtFreeLevel(within, limits).outcome : within(limits);
        },
        draws);
    answer.intervals->noiseIs = noiseIs;
  }
  answer.outcome.models.assign(emitters.size(), false);
  answer.outcome.notes = notes;
  answer.outcome.observer = "camera RGB taken for " + options.colourSpace;
  answer.outcome.reflectances = "charts";
  return answer;
}

std::vector<MatchAnswer> answersOf(const MatchOptions& options, const spectral::DataLibrary& library) {
  std::vector<MatchAnswer> answers;
  if (!options.charts.empty()) {
    const std::vector<stage::PanelEotf> eotfs = eotfsOf(options.ramps, options.charts.size());
    answers.push_back(
        spectral::namingFile(options.targets.front(), [&] { return matchCharts(options, eotfs, library); }));
    describe(options, options.targets.front(), answers.back());
    return answers;
  }
  if (options.noise) {
    throw InputError("--noise", "noise", spectral::formatted("%g", *options.noise),
                     "is of captured charts; it needs --charts");
  }
  const stage::Fixture fixture = stage::readFixture(options.emitters, library);
  const std::vector<stage::PanelEotf> eotfs = eotfsOf(options.ramps, fixture.names.size());
  for (const std::string& target : options.targets) {
    const std::string& file = spectral::looksLikeSpectralFile(target) ? target : options.emitters.front();
    const spectral::Spectrum lamp = library.illuminant(target);
    const std::vector<std::string> filters = options.filters.empty() ? std::vector<std::string>{""} : options.filters;
    for (const std::string& filter : filters) {
      const bool isBare = filter.empty() || filter == "none";
      answers.push_back(spectral::namingFile(file, [&] {
        return matchSpectra(options, fixture, isBare ? lamp : filteredLight(lamp, filter, library), eotfs, library);
      }));
      answers.back().filter = isBare ? "" : filter;
      describe(options, target, answers.back());
    }
  }
  return answers;
}

void match(const MatchOptions& options) {
  for (const std::string& file : {options.output, options.report, options.figure}) {
    spectral::requireWritable(spectral::pathOf(file));
  }
  const auto library = openLibrary();
  const std::vector<MatchAnswer> answers = answersOf(options, library);
  const bool isList = answers.size() > 1 || options.filters.size() > 1 || options.targets.size() > 1;
  if (!options.figure.empty()) {
    if (isList) {
      throw InputError("--figure", "matches", std::to_string(answers.size()), "are too many for a figure; match one");
    }
    writeFigure(answers.front().outcome, library, spectral::pathOf(options.figure));
  }
  if (!options.report.empty()) {
    spectral::writeWholeFile(spectral::pathOf(options.report),
                             isList ? reportOf(answers)
                                    : reportOf(answers.front(), relativeTo(spectral::pathOf(options.report),
                                                                           spectral::pathOf(options.figure))));
  }
  writeJson(spectral::pathOf(options.output), isList ? toJson(answers) : toJson(answers.front()));
  std::cout << (isList ? summaryOf(answers) : summaryOf(answers.front()));
}

}  // namespace

void addStageMatch(CLI::App& stage) {
  CLI::App* command = stage.add_subcommand("match", "Drives of several emitters that reproduce a light");
  const auto options = std::make_shared<MatchOptions>();
  command
      ->add_option("--target", options->targets,
                   "Lights to reproduce: NAME or FILE; with --charts, the one light's chart (CSV)")
      ->required()
      ->expected(1, 256);
  command
      ->add_option("--filters", options->filters,
                   "Gels before each light, one after another: NAME or FILE, with :density where it is not 1; none for "
                   "the bare light")
      ->expected(1, 256);
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
  addPriority(*command, options->priority);
  command->add_option("--colour-space", options->colourSpace,
                      "With --charts: what the camera's RGB is, for colour differences; ACEScg by default");
  command->add_option("--report", options->report, "Markdown to write, for people");
  command->add_option("--figure", options->figure, "PNG to write: the chart as squares in squares");
  addFixtureLimits(*command, options->limits);
  command
      ->add_option("--level", options->level,
                   "fixed: the light's own level; free: its colour, as bright as limits (1 by default) allow")
      ->check(CLI::IsMember({"fixed", "free"}));
  CLI::Option* drives =
      command
          ->add_option(
              "--drives", options->unit,
              "Drives as a desk takes them too: percent, dmx8 (0 to 255) or dmx16 (0 to 65535) of --limits, or of 1")
          ->check(CLI::IsMember({"percent", "dmx8", "dmx16"}));
  command
      ->add_option(
          "--ramps", options->ramps,
          "What a camera saw of the emitters at rising drives (CSV, as of stage linearity): one for all, or one "
          "an emitter; --drives are then what gives the light")
      ->expected(1, 64)
      ->needs(drives);
  command->add_option("--noise", options->noise, "Of the charts' values, as a share; estimated from them by default")
      ->check(CLI::Range(0.0, 0.5));
  command
      ->add_option("--samples", options->samples,
                   "Draws of that noise for the 95 % intervals: 20 to 100000, or 0 for none; 200 by default")
      ->check(samplesCheck);
  command->add_option("--seed", options->seed, "Of those draws; 1 by default");
  command->add_flag("--as-captured", options->asCaptured, "Match although a chart shows a mistake: it becomes a note");
  command->add_option("--json", options->output, "JSON to write: drives and residual")->required();
  command->callback([options] { match(*options); });
}

}  // namespace metamer::lutgen
