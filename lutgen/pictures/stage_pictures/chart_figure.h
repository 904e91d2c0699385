// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

namespace metamer::lutgen {

/// Charts as squares in squares (figs. 2.10 and 2.18): each patch's ground is the target, the square in it what was
/// made. Where they are alike, the inner square cannot be seen.
struct ChartComparison {
  Eigen::Matrix3Xd target;  ///< linear camera RGB
  Eigen::Matrix3Xd made;
};

/// Writes a PNG, one chart below the other.
/// @param columns         patches a row
/// @param srgbFromCamera  to linear Rec.709, white at 1
/// @throws spectral::InputError where it cannot be written
void writeChartFigure(const std::vector<ChartComparison>& charts, int columns, const Eigen::Matrix3d& srgbFromCamera,
                      const std::filesystem::path& file);

/// Camera RGB to linear Rec.709 with the camera's white at 1, adapted.
Eigen::Matrix3d displayFromCamera(const Eigen::Matrix3d& xyzFromCamera, const Eigen::Vector3d& whiteRgb,
                                  const Eigen::Matrix3d& rec709FromXyz, const Eigen::Vector3d& rec709White);

}  // namespace metamer::lutgen
