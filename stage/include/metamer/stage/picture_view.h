// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <span>

namespace metamer::stage {

/// Linear pixels of a picture, held by whoever read it.
struct PictureView {
  std::span<const float> values;  ///< height x width x channels, top row first
  int width = 0;
  int height = 0;
  int channels = 3;
  std::array<int, 3> colours = {0, 1, 2};  ///< channels of red, green, blue

  /// @param x, y  within the picture
  Eigen::Vector3d at(int x, int y) const {
    const std::size_t pixel =
        static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
    const float* first = values.data() + pixel * static_cast<std::size_t>(channels);
    return {first[colours[0]], first[colours[1]], first[colours[2]]};
  }
};

}  // namespace metamer::stage
