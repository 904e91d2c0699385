// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>

namespace metamer::lutgen {

/// Each adds one subcommand of "skin".
void addSkinEstimate(CLI::App& skin);
void addSkinEdit(CLI::App& skin);
void addSkinSample(CLI::App& skin);

}  // namespace metamer::lutgen
