// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "checked_words.h"
#include "farm_job.h"
#include "picture_commands.h"

namespace metamer::lutgen {

/// Each adds a kind of work to `lutgen job`.
/// @param words  options of every task
void addJobApply(CLI::App& job, const std::vector<std::string>& words);
void addJobBake(CLI::App& job, const std::vector<std::string>& words);

/// Checks a task's command line as farm::requireUnderstood does; --quiet is of every command.
void requireUnderstood(void (*addCommand)(CLI::App&), std::vector<std::string> words);

/// Text as a word of a task's command line.
farm::Word plain(const std::string& word);

/// The program lutgen beside this one.
std::filesystem::path lutgenProgram();

}  // namespace metamer::lutgen
