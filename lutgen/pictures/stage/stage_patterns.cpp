// SPDX-License-Identifier: Apache-2.0
#include <charconv>
#include <cmath>
#include <memory>

#include "apply/frames.h"
#include "metamer/spectral/formatted.h"
#include "metamer/spectral/input_error.h"
#include "metamer/spectral/message_line.h"
#include "metamer/spectral/path_text.h"
#include "metamer/spectral/pending_file.h"
#include "progress.h"
#include "run.h"
#include "stage/stage_commands.h"
#include "stage/stage_skeleton.h"
#include "stage_pictures/wall_patterns.h"

namespace metamer::lutgen {
namespace {

using spectral::InputError;

/// Of a side, in pixels: what DPX and PNG writers of this library take.
constexpr int kLongestSide = 32768;

struct PatternOptions {
  std::string stage;
  std::string pictures;
  std::string resolution;
  std::string square = "1x1";
  std::string type;
  double pitchMm = 0;
  double distanceM = 1;
  int steps = 17;
  int firstFrame = 1;
};

/// Two numbers with an x between them.
std::array<double, 2> pairOf(const std::string& text, const std::string& option, const std::string& field,
                             const std::string& remedy) {
  std::array<double, 2> pair{};
  const char* end = text.data() + text.size();
  const auto first = std::from_chars(text.data(), end, pair[0]);
  const bool hasMiddle = first.ec == std::errc() && first.ptr != end && *first.ptr == 'x';
  const auto second = hasMiddle ? std::from_chars(first.ptr + 1, end, pair[1]) : first;
  if (!hasMiddle || second.ec != std::errc() || second.ptr != end || !std::isfinite(pair[0]) ||
      !std::isfinite(pair[1])) {
    throw InputError(option, field, text, remedy);
  }
  return pair;
}

WallRaster rasterOf(const PatternOptions& options) {
  WallRaster raster;
  const std::string form = "must be the wall's pixels, WIDTHxHEIGHT, such as 3840x2160, 1 to 32768 each";
  const auto size = pairOf(options.resolution, "--resolution", "size", form);
  for (const double side : size) {
    if (!(side >= 1 && side <= kLongestSide) || side != std::floor(side)) {
      throw InputError("--resolution", "size", options.resolution, form);
    }
  }
  raster.width = static_cast<int>(size[0]);
  raster.height = static_cast<int>(size[1]);
  const auto square = pairOf(options.square, "--square", "size", "must be metres, WIDTHxHEIGHT, such as 1x1");
  const double width = std::round(square[0] * 1000 / options.pitchMm);
  const double height = std::round(square[1] * 1000 / options.pitchMm);
  if (!(width >= 1 && height >= 1 && width <= raster.width && height <= raster.height)) {
    throw InputError("--square", "size", options.square,
                     spectral::formatted("is %.0f x %.0f pixels at a pitch of %g mm; it must have some, and lie within "
                                         "the wall's %d x %d",
                                         width, height, options.pitchMm, raster.width, raster.height));
  }
  raster.squareWidth = static_cast<int>(width);
  raster.squareHeight = static_cast<int>(height);
  return raster;
}

/// Names of the pictures: a frame each where the name has a place for its number, else the pattern's name before the
/// extension.
class PictureNames {
 public:
  PictureNames(const PatternOptions& options, const std::vector<WallPattern>& patterns)
      : m_place(spectral::pathOf(options.pictures)),
        m_frames(FramePattern::in(options.pictures)),
        m_first(options.firstFrame) {
    for (const WallPattern& pattern : patterns) {
      m_patterns.push_back(pattern.name);
    }
  }

  std::filesystem::path file(std::size_t index) const {
    if (m_frames) {
      return spectral::pathOf(m_frames->file(m_first + static_cast<int>(index)));
    }
    return m_place.parent_path() / spectral::pathOf(spectral::utf8(m_place.stem()) + "_" + m_patterns[index] +
                                                    spectral::utf8(m_place.extension()));
  }

  /// For a comment of the stage file: one line whatever the name holds.
  std::string shown(const std::string& pattern) const {
    for (std::size_t i = 0; i < m_patterns.size(); ++i) {
      if (m_patterns[i] == pattern) {
        return spectral::messageLine(spectral::utf8(file(i).filename()), spectral::kLongestMessage);
      }
    }
    return pattern;
  }

 private:
  std::filesystem::path m_place;
  std::optional<FramePattern> m_frames;
  int m_first;
  std::vector<std::string> m_patterns;
};

void writePatterns(const PatternOptions& options) {
  const SampleType type = patternType(spectral::pathOf(options.pictures), options.type);
  const WallRaster raster = rasterOf(options);
  StageSkeleton skeleton;
  skeleton.ramp = rampDrives(options.steps, type);
  const std::vector<WallPattern> patterns = wallPatterns(skeleton.ramp);
  const PictureNames names(options, patterns);
  spectral::requireWritable(spectral::pathOf(options.stage));
  for (std::size_t i = 0; i < patterns.size(); ++i) {
    spectral::requireWritable(names.file(i));
  }
  // The square as it is lit: whole pixels.
  skeleton.squareWidthM = raster.squareWidth * options.pitchMm / 1000;
  skeleton.squareHeightM = raster.squareHeight * options.pitchMm / 1000;
  skeleton.distanceM = options.distanceM;
  skeleton.picture = [&](const std::string& pattern) { return names.shown(pattern); };
  Progress progress("patterns");
  for (std::size_t i = 0; i < patterns.size(); ++i) {
    writePattern(patterns[i], raster, type, names.file(i));
    progress.show(static_cast<double>(i + 1) / static_cast<double>(patterns.size()));
  }
  spectral::writeWholeFile(spectral::pathOf(options.stage), skeletonText(skeleton));
  summarise(spectral::formatted("%zu pictures of %d x %d, square of %d x %d (%g m x %g m), %d steps a channel",
                                patterns.size(), raster.width, raster.height, raster.squareWidth, raster.squareHeight,
                                skeleton.squareWidthM, skeleton.squareHeightM, options.steps));
}

}  // namespace

void addStagePatterns(CLI::App& stage) {
  CLI::App* command = stage.add_subcommand("patterns", "Test pictures for a wall, and the stage file to fill in");
  const auto options = std::make_shared<PatternOptions>();
  command->add_option("-o,--output", options->stage, "Stage file (.yaml) to write: what each capture is for")
      ->required();
  command
      ->add_option("--pictures", options->pictures,
                   "Pictures to write: wall.png gives wall_red.png ..., wall.####.exr gives frames; .exr, .png, .dpx "
                   "or .tif")
      ->required();
  command->add_option("--resolution", options->resolution, "The wall's pixels, WIDTHxHEIGHT")->required();
  command->add_option("--pitch", options->pitchMm, "Of the panels, mm from pixel to pixel")
      ->required()
      ->check(CLI::Range(0.01, 1000.0));
  command->add_option("--square", options->square, "The calibration square in metres, WIDTHxHEIGHT; 1x1 by default");
  command->add_option("--distance", options->distanceM, "From the square to the chart, in metres; 1 by default")
      ->check(CLI::Range(0.001, 1000.0));
  command->add_option("--steps", options->steps, "Of each channel's ramp, none and full included; 17 by default")
      ->check(CLI::Range(3, 100));
  command->add_option("--first-frame", options->firstFrame, "Number of the first frame; 1 by default")
      ->check(CLI::Range(0, 1000000));
  command->add_option(
      "-d,--type", options->type,
      "Type of the samples: half, float, uint8, uint10 or uint12 (DPX), uint16; by the extension half, 10 bits "
      "(DPX), 8 (PNG) or 16 (TIFF)");
  command->callback([options] { writePatterns(*options); });
}

}  // namespace metamer::lutgen
