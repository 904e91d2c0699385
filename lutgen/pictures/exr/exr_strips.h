// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "exr/exr_samples.h"

namespace metamer::lutgen {

/// A picture that is too large to lie in memory with all its channels.
struct ExrStrips {
  /// Names that rise as bytes do, which the format asks for.
  std::vector<ExrChannel> channels;
  ExrCompression compression = ExrCompression::Zip;
  ExrBox dataWindow;
  ExrBox displayWindow;
  float pixelAspectRatio = 1;
  std::vector<ExrAttribute> attributes;  ///< others
  /// Fills the samples of some whole rows: row by row, of each row channel by channel. Called on several threads.
  std::function<void(const ExrRectangle& rows, char* samples)> fill;
};

/// Writes scan lines, some strips at a time, whole or not at all. The file is the same for any count of threads.
/// @param threads  0: as many as the machine has
/// @throws spectral::InputError where the disk is full or the place cannot be written, and what `fill` throws
void writeExrStrips(const ExrStrips& picture, const std::filesystem::path& file, int threads);

}  // namespace metamer::lutgen
