// SPDX-License-Identifier: Apache-2.0
#include "metamer/ocio/exposure_invariant_chain.h"

#include <Eigen/LU>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

#include "chain/chromaticity_table.h"
#include "operators/matrix_operator.h"

namespace metamer::ocio {
namespace {

/// The middle of the exposures that the chain keeps apart.
constexpr double kMiddle = 0.18;

/// Slope of the amount's logarithm: the table's third axis spans 2 kChainStops and the toe below them.
double amountSlope() {
  return 1.0 / (2.0 * kChainStops + 1.0 / std::numbers::ln2);
}

/// The identity on two channels, slope * log2 on the third, with a straight toe that meets it smoothly and passes zero.
OCIO::LogCameraTransformRcPtr amountLog(OCIO::TransformDirection direction) {
  // A camera log is a straight line below its break: one that lies beyond every chromaticity gives the identity.
  constexpr double kBeyond = 1048576.0;
  const double slope = amountSlope();
  const double darkest = kMiddle * std::exp2(-kChainStops);
  auto log = OCIO::LogCameraTransform::Create({kBeyond, kBeyond, darkest});
  log->setBase(2.0);
  log->setLogSideSlopeValue({1.0, 1.0, slope});
  log->setLogSideOffsetValue({kBeyond - 20.0, kBeyond - 20.0, slope * (1.0 / std::numbers::ln2 - std::log2(darkest))});
  log->setLinSideSlopeValue({1.0, 1.0, 1.0});
  log->setLinSideOffsetValue({0.0, 0.0, 0.0});
  log->setLinearSlopeValue({1.0, 1.0, slope / (std::numbers::ln2 * darkest)});
  log->setDirection(direction);
  return log;
}

/// The curve that turns ticks into even steps: identity on the third channel.
OCIO::Lut1DTransformRcPtr tickCurves(const std::array<std::vector<double>, 2>& ticks) {
  const int steps = tickSteps(static_cast<int>(ticks[0].size()));
  auto curve = OCIO::Lut1DTransform::Create(static_cast<unsigned long>(steps) + 1, false);
  std::array<std::size_t, 2> cell{};
  for (int entry = 0; entry <= steps; ++entry) {
    const double at = static_cast<double>(entry) / steps;
    std::array<double, 2> value{};
    for (int axis = 0; axis < 2; ++axis) {
      const auto& along = ticks[axis];
      while (cell[axis] + 2 < along.size() && along[cell[axis] + 1] <= at) {
        ++cell[axis];
      }
      const double within = (at - along[cell[axis]]) / (along[cell[axis] + 1] - along[cell[axis]]);
      value[axis] = (static_cast<double>(cell[axis]) + within) / static_cast<double>(along.size() - 1);
    }
    curve->setValue(static_cast<unsigned long>(entry), static_cast<float>(value[0]), static_cast<float>(value[1]),
                    static_cast<float>(at));
  }
  return curve;
}

}  // namespace

OCIO::GroupTransformRcPtr exposureInvariantChain(const sip::TransformSpec& spec,
                                                 const sip::SpectralTransform& transform, const ChainOptions& options) {
  const int size = options.size;
  assert(size >= 3 && size <= 129);
  const auto [plane, lattice] = buildChromaticityTable(spec, transform, size, options.fitted);

  auto table = OCIO::Lut3DTransform::Create(static_cast<unsigned long>(size));
  table->setInterpolation(OCIO::INTERP_TETRAHEDRAL);
  const double slope = amountSlope();
  for (int i = 0; i < size; ++i) {
    for (int j = 0; j < size; ++j) {
      const Eigen::Vector3d& node = lattice.nodes[lattice.index(i, j)];
      for (int k = 0; k < size; ++k) {
        const double amount = static_cast<double>(k) / (size - 1) + slope * node[2];
        table->setValue(static_cast<unsigned long>(i), static_cast<unsigned long>(j), static_cast<unsigned long>(k),
                        static_cast<float>(node[0]), static_cast<float>(node[1]), static_cast<float>(amount));
      }
    }
  }

  auto group = OCIO::GroupTransform::Create();
  group->appendTransform(matrixOperator(plane.input.fromRgb));
  group->appendTransform(OCIO::FixedFunctionTransform::Create(OCIO::FIXED_FUNCTION_XYZ_TO_xyY));
  const auto shift = [](double offset) {
    auto matrix = OCIO::MatrixTransform::Create();
    const double offsets[4] = {0.0, offset, 0.0, 0.0};
    matrix->setOffset(offsets);
    return matrix;
  };
  group->appendTransform(shift(-plane.input.offset));
  group->appendTransform(amountLog(OCIO::TRANSFORM_DIR_FORWARD));
  group->appendTransform(tickCurves(lattice.ticks));
  group->appendTransform(table);
  group->appendTransform(amountLog(OCIO::TRANSFORM_DIR_INVERSE));
  group->appendTransform(shift(plane.output.offset));
  auto back = OCIO::FixedFunctionTransform::Create(OCIO::FIXED_FUNCTION_XYZ_TO_xyY);
  back->setDirection(OCIO::TRANSFORM_DIR_INVERSE);
  group->appendTransform(back);
  group->appendTransform(matrixOperator(plane.output.fromRgb.inverse()));
  return group;
}

}  // namespace metamer::ocio
