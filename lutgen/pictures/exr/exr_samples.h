// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "exr/exr_change.h"
#include "exr/exr_file.h"

namespace metamer::lutgen {

/// A rectangle of a part's samples: row by row, of each row channel by channel.
struct ExrRectangle {
  int x = 0;
  int y = 0;
  int width = 0;
  int height = 0;
};

/// Bytes of one row. @param y  of the picture: subsampled channels are in some rows only
std::size_t exrRowBytes(const std::vector<ExrChannel>& channels, const ExrRectangle& rectangle, int y);
/// Bytes of all.
std::size_t exrBytes(const std::vector<ExrChannel>& channels, const ExrRectangle& rectangle);

/// Numbers as samples, one after another. What half cannot hold becomes the largest half.
void putSamples(char* bytes, ExrType type, std::span<const float> values);

/// Changes the colours of samples.
/// @param before, after  the part's channels; types alone may differ
/// @param colours  all are of this part
/// @return the samples with the types of `after`
std::string changedSamples(std::string samples, const ExrRectangle& rectangle, const std::vector<ExrChannel>& before,
                           const std::vector<ExrChannel>& after, const std::vector<ExrColours>& colours,
                           const PixelFunction& pixels);

}  // namespace metamer::lutgen
