// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

#include "apply/any_picture.h"

namespace metamer::lutgen {

/// Pixels of a wall, and the lit square amid them.
struct WallRaster {
  int width = 0;
  int height = 0;
  int squareWidth = 0;  ///< at most the wall's
  int squareHeight = 0;
};

/// One picture that a wall shows while the camera takes its capture: a colour all over, or in the square on black.
struct WallPattern {
  std::string name;       ///< "red", "square_red", "ramp_red_03": letters, digits, lines
  Eigen::Vector3d drive;  ///< 0 ... 1, as the file's type holds it
  bool isSquare = false;
};

/// The value that a type holds for a drive of 0 ... 1: the nearest code over the full one, or the nearest half or
/// float.
double heldDrive(double drive, const SampleType& type);

/// Drives of a ramp from none to full in equal steps, as the type holds them.
/// @param steps  2 or more
/// @throws spectral::InputError where the type holds fewer different ones
std::vector<double> rampDrives(int steps, const SampleType& type);

/// Name of a step of a channel's ramp.
std::string rampName(const std::string& channel, std::size_t step);

/// Red, green, blue, white and black all over, a square of each but black, and a ramp of squares a channel.
std::vector<WallPattern> wallPatterns(const std::vector<double>& ramp);

/// The type of samples that walls are sent by files of such a name: half in EXR, 10 bits in DPX, 8 in PNG, 16 in TIFF.
/// @param asked  a type's name, or empty
/// @throws spectral::InputError: an extension that is none of these, a type that the format does not hold
SampleType patternType(const std::filesystem::path& file, const std::string& asked);

/// Writes a pattern, whole or not at all. Its values are drives: no colour space is said of them.
/// @throws spectral::InputError
void writePattern(const WallPattern& pattern, const WallRaster& raster, const SampleType& type,
                  const std::filesystem::path& file);

}  // namespace metamer::lutgen
