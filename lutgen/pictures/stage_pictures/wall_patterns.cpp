// SPDX-License-Identifier: Apache-2.0
#include "stage_pictures/wall_patterns.h"

#include <OpenImageIO/imagebufalgo.h>

#include <array>
#include <cmath>
#include <cstdint>

#include "metamer/spectral/formatted.h"
#include "metamer/spectral/input_error.h"
#include "metamer/spectral/path_text.h"
#include "metamer/spectral/text.h"
#include "picture.h"

namespace metamer::lutgen {
namespace {

using OIIO::TypeDesc;
using spectral::InputError;

constexpr std::array<const char*, 3> kChannels = {"red", "green", "blue"};

/// What a kind of file holds, its usual type first.
struct PatternFormat {
  std::array<const char*, 2> extensions;
  std::vector<std::string> types;
};

const std::vector<PatternFormat>& patternFormats() {
  static const std::vector<PatternFormat> formats = {{{".exr", ".exr"}, {"half", "float"}},
                                                     {{".dpx", ".dpx"}, {"uint10", "uint12", "uint8", "uint16"}},
                                                     {{".png", ".png"}, {"uint8", "uint16"}},
                                                     {{".tif", ".tiff"}, {"uint16", "uint8"}}};
  return formats;
}

/// Bits of a sample's full code; 0 where samples are floating.
int codeBits(const SampleType& type) {
  return type.bits > 0 ? type.bits : type.type == TypeDesc::UINT8 ? 8 : type.type == TypeDesc::UINT16 ? 16 : 0;
}

/// What OpenImageIO is to be given for a drive: of 10 and 12 bits the 16-bit code that stands for theirs.
float storedValue(double drive, const SampleType& type) {
  if (type.bits == 0) {
    return static_cast<float>(drive);
  }
  const auto code = static_cast<unsigned>(std::lround(drive * ((1 << type.bits) - 1)));
  const auto lifted = (code << (16 - type.bits)) | (code >> (2 * type.bits - 16));
  return static_cast<float>(lifted) / 65535.0F;
}

}  // namespace

double heldDrive(double drive, const SampleType& type) {
  const int bits = codeBits(type);
  if (bits > 0) {
    const double most = (1 << bits) - 1;
    return std::round(drive * most) / most;
  }
  // Eleven significant bits of a half; a ramp's drives are far above where halves thin out.
  const double scale = type.type == TypeDesc::HALF && drive > 0 ? std::ldexp(1.0, 11 - (std::ilogb(drive) + 1)) : 0;
  return scale > 0 ? std::nearbyint(drive * scale) / scale : static_cast<double>(static_cast<float>(drive));
}

std::vector<double> rampDrives(int steps, const SampleType& type) {
  std::vector<double> drives;
  for (int i = 0; i < steps; ++i) {
    drives.push_back(heldDrive(static_cast<double>(i) / (steps - 1), type));
    if (i > 0 && drives[static_cast<std::size_t>(i)] == drives[static_cast<std::size_t>(i) - 1]) {
      throw InputError("--steps", "steps", std::to_string(steps),
                       "are more than the pictures' type holds apart; ask fewer, or more bits by -d");
    }
  }
  return drives;
}

std::string rampName(const std::string& channel, std::size_t step) {
  return spectral::formatted("ramp_%s_%02zu", channel.c_str(), step);
}

std::vector<WallPattern> wallPatterns(const std::vector<double>& ramp) {
  std::vector<WallPattern> patterns;
  for (const bool isSquare : {false, true}) {
    const std::string prefix = isSquare ? "square_" : "";
    for (int k = 0; k < 3; ++k) {
      patterns.push_back({prefix + kChannels[static_cast<std::size_t>(k)], Eigen::Vector3d::Unit(k), isSquare});
    }
    patterns.push_back({prefix + "white", Eigen::Vector3d::Ones(), isSquare});
    if (!isSquare) {
      patterns.push_back({"black", Eigen::Vector3d::Zero(), false});
    }
  }
  for (int k = 0; k < 3; ++k) {
    for (std::size_t i = 0; i < ramp.size(); ++i) {
      patterns.push_back(
          {rampName(kChannels[static_cast<std::size_t>(k)], i), ramp[i] * Eigen::Vector3d::Unit(k), true});
    }
  }
  return patterns;
}

SampleType patternType(const std::filesystem::path& file, const std::string& asked) {
  const std::string extension = spectral::lowerCase(spectral::utf8(file.extension()));
  for (const PatternFormat& format : patternFormats()) {
    if (extension != format.extensions[0] && extension != format.extensions[1]) {
      continue;
    }
    if (asked.empty()) {
      return sampleTypeNamed(format.types.front());
    }
    for (const std::string& type : format.types) {
      if (type == asked) {
        return sampleTypeNamed(type);
      }
    }
    throw InputError("-d", "type", asked, "is not held by " + extension + "; write " + spectral::joined(format.types));
  }
  throw InputError("--pictures", "extension", extension, "is not written; write .exr, .png, .dpx or .tif");
}

void writePattern(const WallPattern& pattern, const WallRaster& raster, const SampleType& type,
                  const std::filesystem::path& file) {
  OIIO::ImageSpec spec(raster.width, raster.height, 3, type.type);
  if (type.bits > 0) {
    spec.attribute("oiio:BitsPerSample", type.bits);
  }
  spec.attribute("ImageDescription", "drives of an LED wall: " + pattern.name);
  OIIO::ImageBuf pixels(spec);
  const int left = (raster.width - raster.squareWidth) / 2;
  const int top = (raster.height - raster.squareHeight) / 2;
  const OIIO::ROI all(0, raster.width, 0, raster.height);
  const OIIO::ROI lit =
      pattern.isSquare ? OIIO::ROI(left, left + raster.squareWidth, top, top + raster.squareHeight) : all;
  const std::array<float, 3> black{};
  const std::array<float, 3> values = {storedValue(pattern.drive[0], type), storedValue(pattern.drive[1], type),
                                       storedValue(pattern.drive[2], type)};
  if (!OIIO::ImageBufAlgo::fill(pixels, OIIO::cspan<float>(black), all) ||
      !OIIO::ImageBufAlgo::fill(pixels, OIIO::cspan<float>(values), lit)) {
    throw InputError(spectral::utf8(file), "pattern", pattern.name, "cannot be made: " + pixels.geterror());
  }
  writePixels(pixels, file, type.type, "pattern");
}

}  // namespace metamer::lutgen
