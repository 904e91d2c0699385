// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <iostream>
#include <memory>

#include "library.h"
#include "metamer/ocio/stage_config.h"
#include "metamer/spectral/naming_file.h"
#include "metamer/spectral/path_text.h"
#include "metamer/spectral/pending_file.h"
#include "stage/fixture_options.h"
#include "stage/stage_commands.h"
#include "stage/stage_json.h"
#include "stage/stage_reading.h"
#include "stage/stage_report.h"
#include "stage_pictures/chart_figure.h"

namespace metamer::lutgen {
namespace {

struct SolveOptions {
  std::string stage;
  std::string output;
  std::string report;
  std::string figure;
  std::string luts;
  std::string config;
  std::string base;
  std::string checkPictures;
  stage::SolveChoices choices;
  std::string priority;
};

/// The inverses of the wall's EOTFs, where ramps were captured.
std::vector<ocio::PanelSignal> signalsOf(const stage::StageCapture& capture) {
  constexpr int kEntries = 4096;
  std::vector<ocio::PanelSignal> signals;
  if (capture.eotf) {
    for (const stage::PanelEotf& eotf : *capture.eotf) {
      signals.push_back({eotf.gamma, {}});
      for (int i = 0; i < kEntries; ++i) {
        signals.back().signals.push_back(eotf.driveFor(std::pow(static_cast<double>(i) / (kEntries - 1), eotf.gamma)));
      }
    }
  }
  return signals;
}

ocio::StageMatrices matricesOf(const stage::StageResult& result) {
  return {result.name,
          result.solution.wallFromContent,
          result.solution.frustumFromContent,
          result.solution.frustumOffset,
          result.solution.correctedFromCamera,
          result.capture.xyzFromCamera,
          result.capture.xyzFromCamera * result.capture.cameraWhite,
          signalsOf(result.capture)};
}

void writeFigure(const stage::StageResult& result, const spectral::DataLibrary& library, const std::string& file) {
  const auto display = library.colourSpace("Rec.709").linear;
  writeChartFigure(
      {{result.capture.wall.target, result.exposure * result.solution.predicted},
       {result.capture.wall.target, result.solution.corrected}},
      result.capture.columns,
      displayFromCamera(result.capture.xyzFromCamera, result.whiteRgb, display.rgbFromXyz(), display.whiteXyz()),
      spectral::pathOf(file));
}

void solve(const SolveOptions& options) {
  // The places first: what cannot be written is not worth the work.
  for (const std::string& file : {options.output, options.report, options.figure, options.config,
                                  options.luts.empty() ? "" : options.luts + "_in_frustum.clf",
                                  options.checkPictures.empty() ? "" : options.checkPictures + "_target.png"}) {
    spectral::requireWritable(spectral::pathOf(file));
  }
  const auto library = openLibrary();
  stage::StageDescription description = stage::readStage(spectral::pathOf(options.stage));
  if (!options.priority.empty()) {
    description.skinPriority = stage::skinWeightFrom(options.priority);
  }
  const stage::StageResult result = spectral::namingFile(description.where, [&] {
    return stage::solveStage(description, readCapture(description, library, options.checkPictures), options.choices);
  });
  if (!options.config.empty()) {
    const bool hasSignals = result.capture.eotf && !options.luts.empty();
    spectral::writeWholeFile(
        spectral::pathOf(options.config),
        ocio::stageConfigText(matricesOf(result), library, spectral::pathOf(options.config),
                              spectral::pathOf(options.base),
                              spectral::pathOf(hasSignals ? options.luts + "_signal.clf" : std::string())));
  }
  if (!options.luts.empty()) {
    ocio::writeStageFiles(matricesOf(result), spectral::pathOf(options.luts));
  }
  if (!options.figure.empty()) {
    writeFigure(result, library, options.figure);
  }
  if (!options.report.empty()) {
    const std::string figure = relativeTo(spectral::pathOf(options.report), spectral::pathOf(options.figure));
    spectral::writeWholeFile(spectral::pathOf(options.report), reportOf(result, figure));
  }
  writeJson(spectral::pathOf(options.output), toJson(result));
  std::cout << summaryOf(result);
}

}  // namespace

void addStageSolve(CLI::App& stage) {
  CLI::App* command = stage.add_subcommand("solve", "Solve an RGB wall: M, Q, N and the black offset");
  const auto options = std::make_shared<SolveOptions>();
  command->add_option("STAGE", options->stage, "Stage file (.yaml): captures, or spectra")->required();
  command->add_option("-o,--output", options->output, "JSON to write: the matrices and every patch")->required();
  command->add_option("--report", options->report, "Markdown to write, for people");
  command->add_option("--figure", options->figure, "PNG to write: the chart as squares in squares");
  command->add_option("--check-pictures", options->checkPictures,
                      "PREFIX of pictures to write: the charts' pictures with the sampled squares drawn in");
  command->add_flag("--as-captured", options->choices.asCaptured,
                    "Solve although the captures show a mistake (swapped, mirrored, clipped ...): it becomes a note");
  command
      ->add_option("--samples", options->choices.samples,
                   "Draws of the captures' noise for the 95 % intervals: 20 to 100000, or 0 for none; 500 by default")
      ->check(samplesCheck);
  command->add_option("--seed", options->choices.seed, "Of those draws; 1 by default");
  addPriority(*command, options->priority);
  command->add_option("--luts", options->luts,
                      "PREFIX of transforms to write: PREFIX_out_of_frustum, _in_frustum and _post_correction, each "
                      "as .spimtx, .clf and .ctf; with ramps PREFIX_signal, what to send for their drives");
  CLI::Option* config = command->add_option(
      "--config", options->config,
      "OCIO config to write: the wall's spaces (with ramps and --luts also what it is sent) and the "
      "camera's look");
  command->add_option("--base", options->base, "OCIO config to add them to; a new one by default")->needs(config);
  command->callback([options] { solve(*options); });
}

}  // namespace metamer::lutgen
