// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "cube/cube_lattice.h"
#include "metamer/ocio/pixel_processor.h"
#include "metamer/ocio/signal.h"
#include "metamer/sip/colour_differences.h"
#include "metamer/sip/spectral_transform.h"

namespace metamer::ocio {

/// What a lattice should give at a signal.
struct CubeSample {
  CubeStencil stencil;
  Eigen::Vector3f target;  ///< signal
  Symmetric metric;        ///< squared CIEDE2000 of a small deviation of the signal, judged as the error protocol does
  Eigen::Vector3f lab;     ///< of the exact result at the protocol's exposure
  float gain = 1.0F;       ///< from there to the sample's own exposure
  bool isNoise = false;    ///< of black: judged by the metric alone
};

/// Colours spread as the error protocol's probes are: chromaticities evenly over the gamut, exposures evenly between
/// two stops round Y = 0.18 and somewhat beyond. The transform is exact on a chromaticity, and the same at every
/// exposure of it. Beside them what a sensor's noise makes of black, where the signal has codes for it: deviations
/// there are judged against a dark grey's light. Ordered by node.
/// @param axes    of the lattice
/// @param signal  of its values
std::vector<CubeSample> cubeSamples(const sip::SpectralTransform& transform, const Signal& axes, const Signal& signal,
                                    int size, double lowestStop, double highestStop);

/// Judges signals by CIEDE2000 in full, for deviations that are not small.
class CubeJudge {
 public:
  CubeJudge(const sip::SpectralTransform& transform, const Signal& signal)
      : m_toEngine(signal.toEngine), m_differences(transform.space().xyzFromRgb(), transform.whiteXyz()) {}

  /// Of the signals that stand in for the samples' targets. @param rgba  four floats a sample; overwritten
  void errors(std::span<const CubeSample> samples, std::span<float> rgba, std::span<float> result) const;

 private:
  PixelProcessor m_toEngine;
  sip::ColourDifferences m_differences;
};

}  // namespace metamer::ocio
