// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>

namespace metamer::spectral_ref {

/// Each adds one subcommand, which does its work when the command line has been parsed.
void addRender(CLI::App& application);
void addMerge(CLI::App& application);
void addMeasure(CLI::App& application);

/// One line on stderr.
void warn(const std::string& message);

}  // namespace metamer::spectral_ref
