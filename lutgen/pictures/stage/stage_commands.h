// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>

namespace metamer::lutgen {

/// Each adds one command of `lutgen stage`.
void addStageSolve(CLI::App& stage);
void addStageMatch(CLI::App& stage);
void addStageSelect(CLI::App& stage);
void addStageEnvironment(CLI::App& stage);
void addStageSample(CLI::App& stage);
void addStageLinearity(CLI::App& stage);
void addStageEmitter(CLI::App& stage);
void addStagePatterns(CLI::App& stage);

}  // namespace metamer::lutgen
