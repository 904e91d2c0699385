// SPDX-License-Identifier: Apache-2.0
#include "stage/stage_skeleton.h"

#include <array>

#include "metamer/spectral/formatted.h"
#include "stage_pictures/wall_patterns.h"

namespace metamer::lutgen {
namespace {

constexpr std::array<const char*, 3> kChannels = {"red", "green", "blue"};

}  // namespace

std::string skeletonText(const StageSkeleton& skeleton) {
  const auto& picture = skeleton.picture;
  std::string text =
      "# A stage to be captured. Show each picture with no colour management between the file and the panels, take\n"
      "# its capture, linear, all at one exposure and white balance, and save it under the name that stands here.\n"
      "# Then fill in the boxes and corners (pixels of the captures), and: lutgen stage solve\n"
      "metamer_stage: 1\n"
      "colour_space: ACEScg  # what the captures' linear RGB is; see: lutgen list spaces\n\n"
      "# The wall itself, in the camera's view; box: the lit pixels to average, [left, top, right, bottom].\n"
      "primaries:\n";
  for (const char* channel : kChannels) {
    text += std::string("  ") + channel + ": {file: captures/" + channel +
            ".exr, box: [0, 0, 0, 0]}  # the wall shows " + picture(channel) + "\n";
  }
  text += spectral::formatted(
      "\n# The chart, parallel to the lit square, %g m before its middle; corners: the chart's, from the first "
      "patch's\n"
      "# outer corner along its row and round. Find the place and the exposure by %s.\ncharts:\n",
      skeleton.distanceM, picture("square_white").c_str());
  const std::string corners = ".exr, corners: [[0, 0], [0, 0], [0, 0], [0, 0]]}  # ";
  for (const char* channel : kChannels) {
    text += std::string("  ") + channel + ": {file: captures/chart_" + channel + corners + "the wall shows " +
            picture(std::string("square_") + channel) + "\n";
  }
  text += "  target: {file: captures/chart_target" + corners + "the chart in the real place\n";
  text += spectral::formatted("calibration_square: {width_m: %.9g, height_m: %.9g, distance_m: %.9g}\n",
                              skeleton.squareWidthM, skeleton.squareHeightM, skeleton.distanceM);
  text +=
      "\n# What a white chart sends back in the real place; left out, it is the target chart's white patch.\n"
      "# environment: {white: [1.1, 1.0, 0.8]}\n";
  text += "\n# What the camera sees of the panels in its view while they show " + picture("black") +
          ",\n# all other panels lit as in the shot (" + picture("white") + ").\nblack_level: [0, 0, 0]\n";
  text +=
      "\n# What the panels make of what is sent: what the camera sees of each step, a CSV a channel (patch,R,G,B), "
      "the\n"
      "# drive in place of the patch's name. Linear panels need none; see: lutgen stage linearity ramp_red.csv\n"
      "# ramps: {red: captures/ramp_red.csv, green: captures/ramp_green.csv, blue: captures/ramp_blue.csv}\n"
      "#   drive        shown by\n";
  for (std::size_t i = 0; i < skeleton.ramp.size(); ++i) {
    text += spectral::formatted("#   %-11.9g  ", skeleton.ramp[i]);
    for (const char* channel : kChannels) {
      text += (channel == kChannels[0] ? "" : ", ") + picture(rampName(channel, i));
    }
    text += "\n";
  }
  return text;
}

}  // namespace metamer::lutgen
