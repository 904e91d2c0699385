// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "commands.h"
#include "run.h"

namespace metamer::lutgen {

/// Each adds one subcommand, which does its work when the command line has been parsed.
void addApply(CLI::App& application);
void addCompare(CLI::App& application);
/// @param taskWords  options of every task
void addJob(CLI::App& application, const std::vector<std::string>& taskWords);
void addReport(CLI::App& application);
void addSkin(CLI::App& application);
void addStage(CLI::App& application);
void addUplift(CLI::App& application);
void addValidate(CLI::App& application);

}  // namespace metamer::lutgen
