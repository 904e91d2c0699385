// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "metamer/skin/skin_edit.h"

namespace metamer::lutgen {

/// One edit of a command line, in the order in which they stand there.
struct SkinStep {
  /// @param amount  the number
  /// @param width   of the picture whose rows the pixels are
  using Edit = std::function<void(std::span<skin::SkinPixel> pixels, double amount, int width, skin::Matte matte)>;

  std::string text;  ///< "--multiply blood=1.5": for messages
  Edit edit;
  double amount = 0;
  std::string amountFile;  ///< a picture with an amount a pixel, in place of the number; empty: none
  std::string matteFile;   ///< where it takes place; empty: everywhere
};

/// The edits' options, filled by the parser.
struct SkinStepOptions {
  struct Option {
    CLI::Option* option = nullptr;
    std::vector<std::string> texts;
  };
  std::vector<std::unique_ptr<Option>> options;
};

/// --multiply, --set, --smooth, --tan, --flush, --oxygenate, --thicken, --thin, --vitiligo, --matte.
void addSkinSteps(CLI::App& command, SkinStepOptions& options);

/// The edits in the order of the command line. Numbers are checked; files are not yet opened.
/// @throws spectral::InputError
std::vector<SkinStep> skinSteps(const CLI::App& command, const SkinStepOptions& options);

/// Runs an edit over a picture's pixels. @param frame  whose number stands in the names of files with a place for it
/// @throws spectral::InputError: files that cannot be read, of another size, or with amounts out of range
void runSkinStep(const SkinStep& step, std::span<skin::SkinPixel> pixels, int width, int height, int frame);

/// A channel of a picture, FILE or FILE:CHANNEL: by itself the only one, Y, or R.
/// @throws spectral::InputError where it is not there, or of another size
std::vector<float> skinPlane(const std::string& name, int width, int height, int frame);

}  // namespace metamer::lutgen
