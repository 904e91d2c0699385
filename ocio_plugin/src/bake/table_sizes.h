// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

namespace metamer::ocio {

/// Nodes along a side where nothing else is asked for.
inline constexpr int kChainSize = 65;
inline constexpr int kCubeSize = 33;

/// Sizes tried in turn for a tolerance, smallest first.
inline constexpr std::array<int, 6> kSizesOfFiles = {9, 17, 33, 49, 65, 97};
/// The same for the tables of a config, of which there are many: closer together, for smaller files.
inline constexpr std::array<int, 9> kSizesOfConfigs = {9, 13, 17, 21, 25, 33, 41, 49, 65};

}  // namespace metamer::ocio
