// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "integrator/prepared_scene.h"

namespace metamer::spectral_ref {

/// Pixels that see the edge of something: how much of either side falls into them is most of a picture's noise, where
/// its lights are simple. Each sample of such a pixel is the mean of several paths, stratified against each other.
///
/// Found from the scene alone, before any sample: so it biases none, and is the same for all parts of a render.
class EdgeMap {
 public:
  /// Paths a sample where there is an edge.
  static constexpr std::uint32_t kPathsAtEdges = 4;

  explicit EdgeMap(const PreparedScene& prepared);

  /// Looks at a pixel. Not two threads at one pixel.
  void look(int x, int y);
  /// Paths that a sample of a pixel is the mean of.
  std::uint32_t paths(std::size_t pixel) const { return m_isEdge[pixel] != 0 ? kPathsAtEdges : 1U; }

 private:
  const PreparedScene& m_prepared;
  std::vector<std::uint8_t> m_isEdge;
};

}  // namespace metamer::spectral_ref
