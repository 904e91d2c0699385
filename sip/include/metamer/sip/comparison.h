// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "metamer/sip/error_protocol.h"
#include "metamer/spectral/rgb_space.h"

namespace metamer::sip {

/// One colour through two transforms, or at one place of two pictures.
struct ComparedColour {
  std::string name;     ///< of a probe; empty for a pixel
  Eigen::Vector3d rgb;  ///< what went in, linear
  double stop = 0;      ///< exposure of it, 0 at Y = 0.18 for probes of the error protocol
  double deltaE = 0;    ///< CIEDE2000; infinite where one result is not finite and the other is, or another number
};

/// How far two transforms or pictures are apart.
struct Comparison {
  double mean = 0;
  double p99 = 0;
  double max = 0;
  std::size_t worst = 0;  ///< index into colours
  std::vector<ComparedColour> colours;
};

/// Mean, 99th percentile and maximum of the colours' differences.
Comparison summarise(std::vector<ComparedColour> colours);

/// Runs probes at every stop from `lowestStop` to `highestStop` through two transforms of RGBA pixels, in place, linear
/// in `space`; the figure is the error protocol's (docs/error_protocol.md). What has a component above
/// `largestComponent` at a stop is left out there. @throws spectral::InputError: falling stops
Comparison compareTransforms(const spectral::RgbSpace& space, const std::vector<ErrorProtocol::Probe>& probes,
                             int lowestStop, int highestStop, const std::function<void(std::span<float>)>& a,
                             const std::function<void(std::span<float>)>& b,
                             double largestComponent = std::numeric_limits<double>::infinity());

/// Compares two pictures of as many RGBA pixels (else an InputError), linear in `space`. Both are divided by the
/// exposure of the first (its luminance over 0.18), as if every pixel were a probe; what is more than `darkestStop`
/// stops below 0.18 counts as if it were there, so that noise in the dark is no error. A stop is the pixel's own.
Comparison comparePixels(const spectral::RgbSpace& space, std::span<const float> a, std::span<const float> b,
                         int darkestStop = -10);

}  // namespace metamer::sip
