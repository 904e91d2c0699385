// SPDX-License-Identifier: Apache-2.0
#include "metamer/ocio/log_cube.h"

#include <array>
#include <vector>

#include "cube/cube_fit.h"
#include "cube/cube_lattice.h"
#include "cube/cube_samples.h"
#include "cube/sampled_cube.h"
#include "cube/shaper_curve.h"
#include "metamer/ocio/pixel_processor.h"
#include "metamer/sip/probe_limits.h"
#include "metamer/spectral/argument_checks.h"

namespace metamer::ocio {
namespace {

/// Of a cell: as near as this to a node is on it.
constexpr float kOnNode = 0.2F;

Eigen::Vector3f blackOf(const Signal& signal) {
  std::array<float, 4> pixel = {0.0F, 0.0F, 0.0F, 1.0F};
  PixelProcessor(signal.fromEngine).apply(pixel);
  return {pixel[0], pixel[1], pixel[2]};
}

/// The neutral node next below black is no light: it is set so that black itself comes out exactly. The one above is,
/// where black all but lies on it. Left alone, the two do not meet at black where one's result lies beyond a
/// logarithm's toe.
void keepBlack(std::vector<Eigen::Vector3f>& nodes, int size, const Signal& axes, const Signal& signal) {
  const auto black = blackOf(signal);
  if (black.minCoeff() < 0.0F || black.maxCoeff() >= 1.0F) {
    return;  // outside the table
  }
  const CubeStencil stencil = cubeStencil(blackOf(axes), size);
  Eigen::Vector3f& below = nodes[stencil.node];
  Eigen::Vector3f& above = nodes[stencil.node + cornerStep(7, size)];
  if (stencil.weight[0] > kOnNode) {
    below = (black - stencil.weight[3] * above) / stencil.weight[0];
  } else {
    above = (black - stencil.weight[0] * below) / stencil.weight[3];
  }
}

}  // namespace

OCIO::Lut3DTransformRcPtr logCube(const sip::SpectralTransform& transform, const Signal& signal,
                                  const LogCubeOptions& options) {
  const int size = options.size;
  spectral::requireWithin("size", size, kSmallestTable, kLargestTable);
  spectral::requireWithin("lowest stop", options.lowestStop, -sip::kMostStops, options.highestStop);
  spectral::requireWithin("highest stop", options.highestStop, options.lowestStop, sip::kMostStops);
  const Signal axes = options.shaperCurve ? behindShaperCurve(signal, options.shaperCurve) : signal;
  std::vector<Eigen::Vector3f> nodes = sampledCube(transform, axes, signal, size);
  if (options.fitted) {
    keepBlack(nodes, size, axes, signal);
    fitCube(nodes, size, cubeSamples(transform, axes, signal, size, options.lowestStop, options.highestStop),
            CubeJudge(transform, signal), options.belowZero);
  }
  auto table = OCIO::Lut3DTransform::Create(static_cast<unsigned long>(size));
  table->setInterpolation(OCIO::INTERP_TETRAHEDRAL);
  const Eigen::Vector3f* node = nodes.data();
  const auto count = static_cast<unsigned long>(size);
  for (unsigned long blue = 0; blue < count; ++blue) {
    for (unsigned long green = 0; green < count; ++green) {
      for (unsigned long red = 0; red < count; ++red, ++node) {
        table->setValue(red, green, blue, node->x(), node->y(), node->z());
      }
    }
  }
  return table;
}

}  // namespace metamer::ocio
