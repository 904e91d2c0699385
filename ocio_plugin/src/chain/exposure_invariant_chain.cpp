// SPDX-License-Identifier: Apache-2.0
#include "metamer/ocio/exposure_invariant_chain.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "chain/chain_table.h"
#include "chain/signed_log.h"
#include "metamer/ocio/log_cube.h"
#include "metamer/spectral/argument_checks.h"
#include "operators/matrix_operator.h"

namespace metamer::ocio {
namespace {

/// The curve that turns ticks into even steps.
OCIO::Lut1DTransformRcPtr tickCurves(const ChainTicks& ticks) {
  const int steps = tickSteps(static_cast<int>(ticks[0].size()));
  auto curve = OCIO::Lut1DTransform::Create(static_cast<unsigned long>(steps) + 1, false);
  std::array<std::size_t, 3> cell{};
  for (int entry = 0; entry <= steps; ++entry) {
    const double at = static_cast<double>(entry) / steps;
    std::array<float, 3> value{};
    for (int axis = 0; axis < 3; ++axis) {
      const auto& along = ticks[axis];
      while (cell[axis] + 2 < along.size() && along[cell[axis] + 1] <= at) {
        ++cell[axis];
      }
      const double within = (at - along[cell[axis]]) / (along[cell[axis] + 1] - along[cell[axis]]);
      value[axis] =
          static_cast<float>((static_cast<double>(cell[axis]) + within) / static_cast<double>(along.size() - 1));
    }
    curve->setValue(static_cast<unsigned long>(entry), value[0], value[1], value[2]);
  }
  return curve;
}

/// What comes out at the nodes. A node's ratios only add to the value's logarithm.
OCIO::Lut3DTransformRcPtr tableOf(const ChainTable& table) {
  const std::size_t size = table.ticks[0].size();
  auto lut = OCIO::Lut3DTransform::Create(static_cast<unsigned long>(size));
  lut->setInterpolation(OCIO::INTERP_TETRAHEDRAL);
  for (std::size_t i = 0; i < size; ++i) {
    for (std::size_t j = 0; j < size; ++j) {
      for (std::size_t k = 0; k < size; ++k) {
        const double value = signedExponential((2.0 * table.ticks[2][k] - 1.0) * kMostSignedLog);
        const Eigen::Vector3d out = std::abs(value) * (value < 0.0 ? table.below : table.above)[i * size + j];
        lut->setValue(i, j, k, static_cast<float>(signedLog(out[0])), static_cast<float>(signedLog(out[1])),
                      static_cast<float>(signedLog(out[2])));
      }
    }
  }
  return lut;
}

}  // namespace

OCIO::GroupTransformRcPtr exposureInvariantChain(const sip::TransformSpec& spec,
                                                 const sip::SpectralTransform& transform, const ChainOptions& options) {
  spectral::requireWithin("size", options.size, kSmallestTable, kLargestTable);
  const ChainTable table = buildChainTable(spec, transform, options.size, options.fitted);
  auto group = OCIO::GroupTransform::Create();
  group->appendTransform(matrixOperator(table.frame.inputFromRgb));
  group->appendTransform(OCIO::FixedFunctionTransform::Create(OCIO::FIXED_FUNCTION_RGB_TO_HSV));
  group->appendTransform(signedLogOfThird());
  // Saturation goes up to 2.
  group->appendTransform(matrixOperator(Eigen::Vector3d(1.0, 0.5, 1.0).asDiagonal().toDenseMatrix()));
  group->appendTransform(tickCurves(table.ticks));
  group->appendTransform(tableOf(table));
  group->appendTransform(signedExponentialOfAll());
  group->appendTransform(matrixOperator(table.frame.outputFromRgb.inverse()));
  return group;
}

}  // namespace metamer::ocio
