// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>
#include <vector>

namespace metamer::lutgen {

/// One line on stderr, whatever the text holds. Returns the code.
int fail(std::string message, int code);

/// A line each on stderr: what a user should know though the work goes on.
void note(const std::vector<std::string>& notes);

inline constexpr int kFailure = 1;

/// Parses a command line and does what it says.
/// @param addCommands  adds the program's subcommands
/// @return the exit code
int run(int argumentCount, char** arguments, const std::function<void(CLI::App&)>& addCommands);

}  // namespace metamer::lutgen
