// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <array>
#include <string_view>

namespace metamer::lutgen {

/// A subcommand as the help names it.
struct CommandName {
  std::string_view name;
  std::string_view purpose;

  CLI::App* addTo(CLI::App& application) const {
    return application.add_subcommand(std::string(name), std::string(purpose));
  }
};

inline constexpr CommandName kApply{"apply", "Apply a recipe, exactly, or a LUT file to a picture or to frames"};
inline constexpr CommandName kCompare{"compare",
                                      "Tell how far two transforms or pictures are apart; exit 3 beyond the tolerance"};
inline constexpr CommandName kJob{"job", "Write frames of a sequence, or looks of a show, as a job for a farm"};
inline constexpr CommandName kReport{"report", "One HTML page that shows what a recipe does, and how well"};
inline constexpr CommandName kSkin{"skin", "Skin: what it is made of, edits of that, and charts of skins"};
inline constexpr CommandName kStage{"stage", "LED stages: walls, fixtures and what they do to colours"};
inline constexpr CommandName kUplift{"uplift", "Spectra for a picture's colours, as a spectral OpenEXR file"};
inline constexpr CommandName kValidate{"validate",
                                       "Render scenes under both lights of a recipe and judge its transform by them"};

/// What the program lutgen-pictures does.
inline constexpr std::array<CommandName, 8> kPictureCommands = {kApply, kCompare, kJob,    kReport,
                                                                kSkin,  kStage,   kUplift, kValidate};

/// Each adds one subcommand, which does its work when the command line has been parsed.
void addBake(CLI::App& application);
void addList(CLI::App& application);
void addConfig(CLI::App& application);
void addDiff(CLI::App& application);
void addSpectrum(CLI::App& application);
void addPairs(CLI::App& application);

}  // namespace metamer::lutgen
