// SPDX-License-Identifier: Apache-2.0
#include "commands.h"
#include "stage_commands.h"

namespace metamer::lutgen {

void addStage(CLI::App& application) {
  CLI::App* stage = application.add_subcommand("stage", "LED stages: walls, fixtures and what they do to colours");
  stage->require_subcommand(1);
  addStageSolve(*stage);
  addStageMatch(*stage);
  addStageSelect(*stage);
  addStageEnvironment(*stage);
  addStageSample(*stage);
  addStageLinearity(*stage);
  addStageEmitter(*stage);
}

}  // namespace metamer::lutgen
