// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "commands.h"

namespace metamer::lutgen {

/// Exit code of a verdict: what was measured is beyond the tolerance.
inline constexpr int kExceeded = 3;

/// Each adds one subcommand, which does its work when the command line has been parsed.
void addApply(CLI::App& application);
void addCompare(CLI::App& application);
void addStage(CLI::App& application);
void addValidate(CLI::App& application);

}  // namespace metamer::lutgen
