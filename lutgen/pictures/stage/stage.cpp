// SPDX-License-Identifier: Apache-2.0
#include "picture_commands.h"
#include "stage/stage_commands.h"

namespace metamer::lutgen {

void addStage(CLI::App& application) {
  CLI::App* stage = kStage.addTo(application);
  stage->require_subcommand(1);
  addStageSolve(*stage);
  addStageMatch(*stage);
  addStageSelect(*stage);
  addStageEnvironment(*stage);
  addStageSample(*stage);
  addStageLinearity(*stage);
  addStageEmitter(*stage);
  addStagePatterns(*stage);
}

}  // namespace metamer::lutgen
