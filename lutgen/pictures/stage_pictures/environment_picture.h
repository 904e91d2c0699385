// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imageio.h>

#include <Eigen/Core>
#include <array>
#include <filesystem>
#include <memory>
#include <vector>

#include "metamer/stage/stage_geometry.h"

namespace metamer::lutgen {

/// An HDR lat-long read row by row, whatever its size.
class EnvironmentPicture {
 public:
  /// @throws spectral::InputError: cannot be read, no three colour channels, not twice as wide as high
  explicit EnvironmentPicture(std::filesystem::path file);

  const stage::LatLong& layout() const { return m_layout; }

  /// Rows first ... first + count - 1 as RGB, a pixel a column. Rows should be asked for in order.
  /// @param rgb  3 x (count * width), overwritten
  /// @throws spectral::InputError
  void read(int first, int count, Eigen::Matrix3Xf& rgb);

 private:
  std::filesystem::path m_file;
  std::unique_ptr<OIIO::ImageInput> m_input;
  std::unique_ptr<OIIO::ImageBuf> m_tiles;  ///< of a tiled file, which has no rows to read
  stage::LatLong m_layout;
  std::array<int, 3> m_colours{};
  std::vector<float> m_buffer;
};

/// What a white chart that faces `facing` sends back of an environment (section 2.7.2.2). Pixels that are negative or
/// not finite count as black.
/// @throws spectral::InputError
Eigen::Vector3d diffuseLight(const std::filesystem::path& file, const Eigen::Vector3d& facing);

}  // namespace metamer::lutgen
