// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "metamer/spectral/data_library.h"
#include "metamer/stage/chart_grid.h"
#include "metamer/stage/picture_view.h"
#include "metamer/stage/stage_description.h"

namespace metamer::stage {

/// Takes the patches of a chart from a picture of it.
class ChartSampler {
 public:
  struct Sampled {
    Eigen::Matrix3Xd rgb;  ///< a patch a column, row by row; not a number where it cannot be seen
    ChartGrid grid;        ///< that was read
    int quarters = 0;      ///< turns of 90 degrees by which the chart lies against its corners
  };

  /// @param folder      of relative files in the layout
  /// @param saturation  from this value on a pixel is clipped
  /// @throws spectral::InputError: a grid that ChartGrid refuses, names that do not fit it, an unknown reflectance set
  ChartSampler(const StageLayout& layout, const spectral::DataLibrary& library, const std::filesystem::path& folder,
               std::optional<double> saturation = std::nullopt);

  const std::vector<std::string>& names() const { return m_names; }

  /// The mean of each patch's sampled square. A square outside the picture, or with pixels that are not finite, is a
  /// missing patch; one with clipped pixels gets the saturation value. Corners in the picture's order on a chart that
  /// lies turned are told by the chart's own reflectances.
  /// @throws spectral::InputError where the corners are not those of a convex quadrilateral, or the view does not fit
  ///         its values
  Sampled sample(const PictureView& picture, const std::vector<Eigen::Vector2d>& corners) const;

 private:
  StageLayout m_layout;
  std::vector<std::string> m_names;
  Eigen::Matrix3Xd m_expected;  ///< linear RGB of the chart under an even light; empty where it is not known
  std::optional<double> m_saturation;
};

/// The mean over a box of pixels: left, top, right, bottom; the last two are outside.
/// @param where  what messages call the picture
/// @throws spectral::InputError: a box that is empty or leaves the picture, pixels that are not finite, a view that
///         does not fit its values
Eigen::Vector3d meanOfBox(const PictureView& picture, const std::array<int, 4>& box, const std::string& where);

}  // namespace metamer::stage
