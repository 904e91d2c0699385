// SPDX-License-Identifier: Apache-2.0
#include <iostream>
#include <memory>

#include "metamer/spectral/input_error.h"
#include "stage_capture.h"
#include "stage_commands.h"
#include "stage_json.h"
#include "stage_result.h"

namespace metamer::lutgen {
namespace {

struct SolveOptions {
  std::string stage;
  std::string output;
};

void solve(const SolveOptions& options) {
  const auto library = spectral::DataLibrary::openDefault();
  const StageResult result = solveStage(sip::readStage(options.stage), library);
  writeJson(options.output, toJson(result));
  std::cout << summaryOf(result);
}

}  // namespace

void addStageSolve(CLI::App& stage) {
  CLI::App* command = stage.add_subcommand("solve", "Solve an RGB wall: M, Q, N and the black offset");
  const auto options = std::make_shared<SolveOptions>();
  command->add_option("STAGE", options->stage, "Stage file (.yaml): captures, or spectra")->required();
  command->add_option("-o,--output", options->output, "JSON to write: the matrices and every patch")->required();
  command->callback([options] { solve(*options); });
}

}  // namespace metamer::lutgen
