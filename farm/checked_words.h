// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>
#include <vector>

#include "farm_job.h"

namespace metamer::farm {

/// Whether a command line would be understood, before a thousand tasks find out. Does none of its work.
/// @param addCommand  adds the subcommand, as the program does
/// @param words       the subcommand's name and what follows
/// @throws CLI::ParseError as the command itself would
void requireUnderstood(const std::function<void(CLI::App&)>& addCommand, std::vector<std::string> words);

/// Words behind a bare -- of the command `job`, taken off the program's arguments: options of every task.
std::vector<std::string> takeTaskWords(int& argumentCount, char** arguments);

/// The options --openjd DIR and --slurm DIR of a command that writes jobs, one of which must be given.
class TargetOptions {
 public:
  void addTo(CLI::App& command);
  /// @throws CLI::ValidationError: neither or both
  JobTarget target() const;

 private:
  std::string m_openJd;
  std::string m_slurm;
};

}  // namespace metamer::farm
