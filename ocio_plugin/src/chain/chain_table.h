// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "chain/chain_frame.h"
#include "chain/chain_ticks.h"

namespace metamer::ocio {

/// A spectral transform over hue and saturation. A node holds the output's channels for a value of 1, and for one of
/// -1.
struct ChainTable {
  ChainFrame frame;
  ChainTicks ticks;
  std::vector<Eigen::Vector3d> above;  ///< saturation fastest
  std::vector<Eigen::Vector3d> below;
};

/// Crowds the nodes where the transform bends and, of colours of light, solves their values for least error.
/// @param spec    what `transform` was made from
/// @param size    nodes along a side
/// @param fitted  false: the transform's own values at the nodes
ChainTable buildChainTable(const sip::TransformSpec& spec, const sip::SpectralTransform& transform, int size,
                           bool fitted);

}  // namespace metamer::ocio
