// SPDX-License-Identifier: Apache-2.0
#include "metamer/ocio/representation.h"

#include <array>
#include <cassert>
#include <vector>

#include "cube_fit.h"
#include "cube_lattice.h"
#include "cube_samples.h"
#include "matrix_operator.h"
#include "metamer/ocio/exposure_invariant_chain.h"
#include "metamer/ocio/pixel_processor.h"
#include "sampled_cube.h"

namespace metamer::ocio {
namespace {

/// Sets the neutral node next below black, which is no light, so that black itself comes out exactly: it lies between
/// two nodes, and where its neighbours' results lie beyond a logarithm's toe the two do not meet there of themselves.
void keepBlack(std::vector<Eigen::Vector3f>& nodes, int size, const Signal& signal) {
  std::array<float, 4> pixel = {0.0F, 0.0F, 0.0F, 1.0F};
  PixelProcessor(signal.fromEngine).apply(pixel);
  const Eigen::Vector3f black(pixel[0], pixel[1], pixel[2]);
  if (black.minCoeff() < 0.0F || black.maxCoeff() >= 1.0F) {
    return;  // outside the table
  }
  const CubeStencil stencil = cubeStencil(black, size);
  Eigen::Vector3f* const below = nodes.data() + stencil.node;
  *below = (black - stencil.weight[3] * below[cornerStep(7, size)]) / stencil.weight[0];
}

}  // namespace

std::string nameOf(Representation representation) {
  switch (representation) {
    case Representation::Identity:
      return "identity";
    case Representation::Matrix:
      return "matrix";
    case Representation::LogCube:
      return "log cube";
    case Representation::ExposureInvariantChain:
      return "exposure-invariant chain";
  }
  return {};
}

OCIO::Lut3DTransformRcPtr logCube(const sip::SpectralTransform& transform, const Signal& signal,
                                  const LogCubeOptions& options) {
  const int size = options.size;
  assert(size >= kSmallestTable && size <= kLargestTable);
  std::vector<Eigen::Vector3f> nodes = sampledCube(transform, signal, size);
  if (options.fitted) {
    keepBlack(nodes, size, signal);
    fitCube(nodes, size, cubeSamples(transform, signal, size, options.lowestStop, options.highestStop),
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

OCIO::GroupTransformRcPtr engineOperators(Representation representation, const sip::TransformSpec& spec,
                                          const sip::SpectralTransform& transform, int size) {
  auto group = OCIO::GroupTransform::Create();
  switch (representation) {
    case Representation::Identity:
      break;
    case Representation::Matrix:
      group->appendTransform(matrixOperator(transform.unconstrainedMatrix()));
      break;
    case Representation::ExposureInvariantChain:
      return exposureInvariantChain(spec, transform, {.size = size});
    case Representation::LogCube:
      assert(false);
      break;
  }
  return group;
}

}  // namespace metamer::ocio
