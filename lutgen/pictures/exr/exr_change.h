// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "exr/exr_file.h"

namespace metamer::lutgen {

/// Changes RGBA pixels in place, alpha 1; safe on several threads. Empty: nothing changes.
using PixelFunction = std::function<void(std::span<float> rgba)>;

/// Which channels of a part are colours.
struct ExrColours {
  int part = 0;
  std::array<int, 3> channels{};  ///< red, green, blue
  int alpha = -1;                 ///< that goes with them; -1: none
};

/// What is to become of a file.
struct ExrChange {
  std::vector<ExrColours> colours;
  PixelFunction pixels;
  std::optional<ExrType> type;                ///< of the colours and their alpha; left out: as they are
  std::optional<ExrCompression> compression;  ///< of all parts that are not deep
  std::optional<std::array<float, 8>> chromaticities;
};

/// The changed file, whole. All that is not changed has the bits it had: chunks without colours are copied as they are,
/// header attributes too, known or not. Pixels with a component that is not finite stay; what half cannot hold becomes
/// the largest half.
/// @param threads  above 0; the result is the same for any
/// @throws spectral::InputError
std::string changedExr(const ExrFile& file, const ExrChange& change, int threads);

/// Whether channels other than the colours lose bits when the part is packed again.
bool losesOtherChannels(const ExrFile& file, const ExrChange& change);

}  // namespace metamer::lutgen
