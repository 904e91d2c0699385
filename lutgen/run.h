// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>

namespace metamer::lutgen {

/// One line on stderr, whatever the text holds. Returns the code.
int fail(std::string message, int code);

inline constexpr int kFailure = 1;

/// Parses a command line and does what it says.
/// @param addCommands  adds the program's subcommands
/// @return the exit code
int run(int argumentCount, char** arguments, const std::function<void(CLI::App&)>& addCommands);

}  // namespace metamer::lutgen
