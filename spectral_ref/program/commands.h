// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace metamer::spectral_ref {

/// Each adds one subcommand, which does its work when the command line has been parsed.
void addRender(CLI::App& application);
void addMerge(CLI::App& application);
void addMeasure(CLI::App& application);
/// @param renderWords  options of render for every task
void addJob(CLI::App& application, std::vector<std::string> renderWords);

/// Most samples of a pixel.
inline constexpr std::uint64_t kMostSamples = std::uint64_t{1} << 32U;

/// FIRST:END of a flag. @throws CLI::ValidationError where it is none
std::array<std::uint64_t, 2> parseRange(const std::string& flag, const std::string& text);

/// @throws spectral::InputError where a picture's name does not end with .exr
void requireExr(const std::string& file);

/// One line on stderr.
void warn(const std::string& message);

}  // namespace metamer::spectral_ref
