// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <ostream>
#include <string>
#include <vector>

namespace metamer::lutgen {

/// One line on stderr, whatever the text holds. Returns the code.
int fail(const std::string& message, int code);

/// A line each on stderr: what a user should know though the work goes on. Nothing with --quiet.
void note(const std::vector<std::string>& notes);

/// The line that a command ends with: what was made, how far it is from the engine where that is known, and the seconds
/// since the program began. On stdout, or on stderr where the result went to stdout; nothing with --quiet.
/// @param text  without the seconds
void summarise(const std::string& text);

/// Where results go that are asked for on standard output, and with them every word to stderr.
std::ostream& standardOutput();

/// Where reports go: stdout until standardOutput() was called, then stderr. Nothing with --quiet.
std::ostream& words();

/// Whether --quiet was given.
bool isQuiet();

inline constexpr int kFailure = 1;
/// Exit code of a verdict: what was measured is beyond the tolerance, or differs.
inline constexpr int kExceeded = 3;

/// Parses a command line and does what it says. Every command but a list has --quiet, and refuses numbers that are not
/// finite; signals leave nothing behind.
/// @param addCommands  adds the program's subcommands
/// @return the exit code
int run(int argumentCount, char** arguments, const std::function<void(CLI::App&)>& addCommands);

}  // namespace metamer::lutgen
