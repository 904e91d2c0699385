// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "chain/chain_probe.h"

namespace metamer::ocio {

/// Ticks of a table lie on multiples of 1 / tickSteps(size), so that a curve with this many steps bends at them
/// exactly. Hue's sextants and a saturation of 1 are among the multiples. A small table's error is far above what finer
/// steps would save, and its curve would be most of its file.
constexpr int tickSteps(int size) {
  return size < 48 ? 1020 : 4080;
}

/// Where a table's nodes lie, each 0 ... 1 and rising: along hue, half the saturation, and the signed logarithm of the
/// value.
using ChainTicks = std::array<std::vector<double>, 3>;

/// Ticks that crowd where the transform bends, and toward a saturation of 2, where ratios grow without bound. The
/// hexcone's edges are among them, as far as there are enough.
/// @param size  nodes along a side
ChainTicks placeTicks(const ChainProbe& probe, int size);

}  // namespace metamer::ocio
