// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "compare/error_scale.h"
#include "metamer/sip/comparison.h"
#include "metamer/spectral/observer.h"
#include "metamer/spectral/rgb_space.h"

namespace metamer::lutgen {

struct HeatMapOptions {
  ErrorScale scale;                 ///< of the colours, dark to bright
  std::optional<double> tolerance;  ///< marked on the scale
  std::string title;
  std::string spaceName;  ///< of the gamut that is drawn
  int pictureWidth = 0;   ///< colours are the rows of a picture: its width; 0: they are not
};

/// Draws a comparison as a PNG, on a logarithmic scale that says what its values mean: the largest difference over the
/// plane of chromaticity (CIE 1931 xy; the locus and the space's gamut outlined), and over hue (round the white) and
/// exposure. A picture is drawn a third time as itself.
/// Labels need a font that OIIO finds; without one they are left out.
/// @throws spectral::InputError where the file cannot be written
void writeHeatMap(const std::filesystem::path& file, const sip::Comparison& comparison, const spectral::RgbSpace& space,
                  const spectral::Observer& standardObserver, const HeatMapOptions& options);

}  // namespace metamer::lutgen
